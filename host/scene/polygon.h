// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

namespace rt {

/// Work budget, in comparisons, for triangulating the polygons of a file, to bound the time.
inline constexpr std::int64_t max_polygon_work = std::int64_t{1} << 28;

/// Triangulates a polygon, convex or not, flat or not, by ear clipping: index triples into
/// `corners`, with the polygon's winding. Corners may repeat and lie on edges, and edges may
/// overlap, as where a slit joins a hole to the outside. No triangle is of zero_area; a polygon
/// whose corners lie on one line has none. `work` is the remaining budget. Replaces `triangles`.
/// Returns whether they are exact: if not, two edges cross, the boundary folds over, or the budget
/// is spent.
bool triangulate(std::span<const glm::dvec3> corners, std::int64_t& work,
                 std::vector<std::array<std::uint32_t, 3>>& triangles);

/// Splits the polygons of a file, whatever is wrong with them.
class PolygonSplitter {
   public:
    /// The triangles of a polygon, valid until the next call: none if it has no area. One that
    /// crosses itself, or exceeds the budget, is a fan from its first corner. Each corner adds to
    /// the budget, so that many small faces cannot exhaust it.
    const std::vector<std::array<std::uint32_t, 3>>& split(std::span<const glm::dvec3> corners);

    /// What was left out or could not be triangulated exactly, a sentence each.
    std::vector<std::string> notes(const std::string& file_name) const;

   private:
    std::vector<std::array<std::uint32_t, 3>> parts_;
    std::int64_t work_ = max_polygon_work;
    std::size_t zero_areas_ = 0, fans_ = 0;
};

}  // namespace rt
