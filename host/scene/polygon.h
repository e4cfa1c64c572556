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
    bent,            ///< a corner lies further than max_bend off the polygon's plane
    too_intricate,   ///< the work would exceed the budget
};

/// How far a corner may lie off a polygon's plane, as a share of the polygon's extent, to be taken
/// for flat.
inline constexpr double max_polygon_bend = 0.05;

/// Comparisons that triangulating the polygons of a file may take, so that no file takes for ever.
inline constexpr std::int64_t max_polygon_work = std::int64_t{1} << 28;

/// Splits a polygon, convex or not, into triangles by clipping ears: rows of indices into
/// `corners`, counterclockwise where the polygon is. Corners may repeat and lie on edges, and an
/// edge may run along another one, as where a slit joins a hole to the outside. No triangle is of
/// zero_area. `work` is what is left of the budget; `max_bend` is as max_polygon_bend. `triangles`
/// is replaced, and holds nothing of use when there is a fault.
PolygonFault triangulate(std::span<const glm::dvec3> corners, std::int64_t& work,
                         std::vector<std::array<std::uint32_t, 3>>& triangles,
                         double max_bend = max_polygon_bend);

}  // namespace rt
