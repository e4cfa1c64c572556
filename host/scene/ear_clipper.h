// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "host/scene/polygon.h"

namespace rt {

/// Cuts ears (triangles of three neighboring corners that hold no other corner) off a polygon in
/// the plane until nothing is left (Meisters 1975). Every decision is exact; each ear has a
/// positive area, so that the triangles add up to the polygon and none lies outside it.
class EarClipper {
   public:
    EarClipper(std::vector<glm::dvec2> points, std::int64_t& work,
               std::vector<std::array<std::uint32_t, 3>>& triangles);

    PolygonFault run();

   private:
    using Index = std::uint32_t;

    void link();
    void tidy_all();
    Index tidy(Index corner);
    bool is_idle(Index corner) const;
    bool is_strictly_convex() const;
    bool edges_cross();
    void find_obstacles();
    void clip();
    bool clip_round(bool strict, bool skip);
    bool drop_flat_corner();
    void cut(Index corner);
    bool is_ear(Index corner, bool strict);
    bool blocks(Index other, Index corner, bool strict) const;
    bool pinches(Index other, Index corner) const;
    int turn(Index corner) const;
    bool inside(glm::dvec2 point, Index corner, bool strict) const;

    std::vector<glm::dvec2> points_;
    std::vector<Index> previous_, next_;
    std::vector<char> alive_;
    std::vector<char> repeated_;    ///< shares its place with another corner
    std::vector<Index> obstacles_;  ///< corners that may stand in an ear's way
    Index start_ = 0, count_ = 0;   ///< a corner that is left, and how many are
    std::int64_t& work_;
    std::vector<std::array<std::uint32_t, 3>>& triangles_;
};

}  // namespace rt
