// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "host/scene/line_scanner.h"
#include "host/scene/ply_header.h"
#include "host/scene/scene.h"

namespace rt {

// A fast parallel path for the rows of a binary file that all have the same length.

/// The bytes of an element's rows; empty if a list makes their length vary or they are truncated.
std::optional<std::string_view> fixed_rows(std::string_view data, const PlyElement& element);

/// Reads three properties, given by their places, of rows as returned by fixed_rows; returns
/// whether all numbers are within max_scene_number.
bool read_columns(std::string_view rows, const PlyElement& element,
                  const std::array<std::size_t, 3>& properties, bool swapped,
                  std::vector<glm::dvec3>& target, const ReadPace& pace);

struct PlyFaces {
    std::vector<Scene::Mesh::Face> faces;
    std::size_t bytes = 0;  ///< read from the data
};

/// Reads faces that are all triangles, or all quadrilaterals that pass parts_well, from the start
/// of `data`; a row must have one list. Nothing for all others: rows must then be read one by one.
std::optional<PlyFaces> read_face_block(std::string_view data, const PlyElement& element,
                                        bool swapped, const std::vector<glm::dvec3>& positions,
                                        const ReadPace& pace);

}  // namespace rt
