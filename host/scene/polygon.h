// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace rt {

/// A polygon of more corners is refused by the readers: the time to cut it up grows with the
/// square of their number.
inline constexpr std::size_t max_polygon_corners = 10000;

/// Cuts a polygon, convex or not, flat or nearly so, into triangles with the polygon's own
/// winding (ear clipping; Meisters 1975). Every item holds three indices into `corners`. A simple
/// polygon of n corners yields n - 2 triangles, fewer where corners lie on one line; one that
/// crosses itself yields some, and one without area may yield none.
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const glm::dvec3> corners);

}  // namespace rt
