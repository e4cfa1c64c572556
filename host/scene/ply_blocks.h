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

// A fast parallel path for the rows of a binary file that all have the same length. Returns nothing
// on any other layout or error: ply_rows then reads row by row and reports why.

/// The bytes of an element's rows; empty if a list makes their length vary or they are truncated.
std::optional<std::string_view> fixed_rows(std::string_view data, const PlyElement& element);

struct PlyVertices {
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> normals;  ///< empty without nx, ny, nz
};

/// Takes rows as returned by fixed_rows.
std::optional<PlyVertices> read_vertex_block(std::string_view rows, const PlyElement& element,
                                             bool swapped, const ReadPace& pace);

struct PlyFaces {
    std::vector<Scene::Mesh::Face> faces;
    std::size_t bytes = 0;  ///< read from the data
};

/// Reads faces that are all triangles, or all quadrilaterals that pass parts_well, from the start
/// of `data`; a row must have one list.
std::optional<PlyFaces> read_face_block(std::string_view data, const PlyElement& element,
                                        bool swapped, const std::vector<glm::dvec3>& positions,
                                        const ReadPace& pace);

}  // namespace rt
