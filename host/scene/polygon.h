// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "host/scene/mistakes.h"

namespace rt {

/// What is wrong with a polygon, for Mistakes::note.
struct PolygonBlemish {
    Remedy remedy;
    const char* message;
};

/// Splits a polygon, convex or not, flat or not, by ear clipping: index triples into `corners`,
/// with the polygon's winding. Corners may repeat and lie on edges, and edges may overlap, as where
/// a slit joins a hole to the outside. No triangle is of zero_area. Replaces `triangles`.
///
/// Returns what is wrong, or null: a polygon whose corners lie on one line has no triangles; one
/// whose edges cross or whose boundary folds over is a fan from its first corner, as is one that
/// takes too many comparisons for a file of so many bytes.
const PolygonBlemish* split_polygon(std::span<const glm::dvec3> corners, std::size_t file_bytes,
                                    std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace rt
