// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "host/scene/chunks.h"
#include "host/scene/ply_header.h"
#include "host/scene/scene.h"

namespace rt {

// Rows of a binary file that are all equally long, read side by side. What is of another shape, or
// wrong anywhere, is nothing here: the reader of single rows (ply_rows) then says why.

/// The bytes of an element's rows, or nothing when a list makes them differ or they are too few.
std::optional<std::string_view> fixed_rows(std::string_view data, const PlyElement& element);

struct PlyVertices {
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> normals;  ///< empty without nx, ny, nz
};

/// Rows as fixed_rows gives them.
std::optional<PlyVertices> read_vertex_block(std::string_view rows, const PlyElement& element,
                                             bool swapped, const ReadPace& pace);

struct PlyFaces {
    std::vector<Scene::Mesh::Face> faces;
    std::size_t bytes = 0;  ///< that the rows take
};

/// Triangles alone, or quadrilaterals alone that all part well, from the start of `data`; the row
/// has one list.
std::optional<PlyFaces> read_face_block(std::string_view data, const PlyElement& element,
                                        bool swapped, const std::vector<glm::dvec3>& positions,
                                        const ReadPace& pace);

}  // namespace rt
