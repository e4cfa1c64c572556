// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "host/scene/mistakes.h"

namespace rt {

/// Work budget, in comparisons, for splitting the polygons of a file, to bound the time.
inline constexpr std::int64_t max_polygon_work = std::int64_t{1} << 28;

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
/// whose edges cross or whose boundary folds over is a fan from its first corner, as is one for
/// which the budget is too small. `work` is what is left of it for the file. Each corner adds to
/// it, so that many small faces cannot exhaust it.
const PolygonBlemish* split_polygon(std::span<const glm::dvec3> corners, std::int64_t& work,
                                    std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace rt
