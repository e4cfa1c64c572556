// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace rt {

enum class PolygonFault {
    none,
    zero_area,       ///< all corners lie on one line
    crosses_itself,  ///< two edges cross, or the boundary folds over
    bent,            ///< a corner is farther than max_bend off the polygon's plane
    too_complex,     ///< the work would exceed the budget
};

/// The largest distance of a corner from the polygon's plane, as a fraction of the polygon's
/// extent, at which it still counts as flat.
inline constexpr double max_polygon_bend = 0.05;

/// Work budget, in comparisons, for triangulating the polygons of a file, to bound the time.
inline constexpr std::int64_t max_polygon_work = std::int64_t{1} << 28;

/// Triangulates a polygon, convex or not, by ear clipping: index triples into `corners`, with the
/// polygon's winding. Corners may repeat and lie on edges, and edges may overlap, as where a slit
/// joins a hole to the outside. No triangle is of zero_area. `work` is the remaining budget;
/// `max_bend` is as max_polygon_bend. Replaces `triangles`, whose contents are meaningless on a
/// fault.
PolygonFault triangulate(std::span<const glm::dvec3> corners, std::int64_t& work,
                         std::vector<std::array<std::uint32_t, 3>>& triangles,
                         double max_bend = max_polygon_bend);

}  // namespace rt
