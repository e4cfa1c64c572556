// SPDX-License-Identifier: Apache-2.0
#include "host/scene/polygon.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace rt {
namespace {

using Index = std::uint32_t;
using Triangle = std::array<Index, 3>;
using Points = std::vector<glm::dvec2>;

/// Twice the signed area: positive where a, b, c run counterclockwise.
double area2(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Within the counterclockwise triangle or on its rim.
bool contains(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 p) {
    return area2(a, b, p) >= 0 && area2(b, c, p) >= 0 && area2(c, a, p) >= 0;
}

/// Corners relative to the first, the largest coordinate at most 1: nothing overflows.
std::vector<glm::dvec3> to_unit_size(std::span<const glm::dvec3> corners) {
    std::vector<glm::dvec3> result;
    result.reserve(corners.size());
    double size = 0;
    for (const glm::dvec3& corner : corners) {
        const glm::dvec3 p = corner - corners[0];
        size = std::max({size, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        result.push_back(p);
    }
    if (size == 0) return result;
    for (glm::dvec3& p : result) p = glm::dvec3(p.x / size, p.y / size, p.z / size);
    return result;
}

/// Newell's normal: its components are twice the areas of the polygon's three projections.
glm::dvec3 newell_normal(const std::vector<glm::dvec3>& corners) {
    glm::dvec3 normal(0);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        normal += glm::cross(corners[i], corners[i + 1 < corners.size() ? i + 1 : 0]);
    }
    return normal;
}

/// The polygon seen along the axis on which it shows the most of itself, counterclockwise; empty
/// when it has no area.
Points project(std::span<const glm::dvec3> corners) {
    const std::vector<glm::dvec3> scaled = to_unit_size(corners);
    const glm::dvec3 normal = newell_normal(scaled);
    const glm::dvec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    if (!(size[axis] > 0)) return {};
    int right = (axis + 1) % 3, up = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(right, up);
    Points points;
    points.reserve(scaled.size());
    for (const glm::dvec3& p : scaled) points.emplace_back(p[right], p[up]);
    return points;
}

/// Whether triangles around the first corner cover the polygon: it turns left at every corner and
/// around the first one too (a star that turns left everywhere winds twice and does not).
bool is_convex(const Points& points) {
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec2 &a = points[i], b = points[(i + 1) % n], c = points[(i + 2) % n];
        if (area2(a, b, c) < 0) return false;
        if (i + 1 < n && i > 0 && !(area2(points[0], a, b) > 0)) return false;
    }
    return true;
}

std::vector<Triangle> fan(std::size_t corners) {
    std::vector<Triangle> triangles;
    for (Index i = 2; i < corners; ++i) triangles.push_back({0, i - 1, i});
    return triangles;
}

/// The polygon as a ring of corners, from which ears are cut one by one.
class EarClipper {
   public:
    explicit EarClipper(const Points& points)
        : points_(points),
          previous_(points.size()),
          next_(points.size()),
          left_(static_cast<Index>(points.size())) {
        for (Index i = 0; i < left_; ++i) {
            previous_[i] = i > 0 ? i - 1 : left_ - 1;
            next_[i] = i + 1 < left_ ? i + 1 : 0;
        }
        for (Index i = 0; i < left_; ++i) convex_.push_back(turn(i) > 0);
    }

    std::vector<Triangle> cut_all() {
        Index corner = 0, refused = 0;
        while (left_ > 3) {
            const bool stuck = refused >= left_;
            if (stuck) {
                corner = least_bad(corner);
                ++times_stuck_;
            }
            if (stuck || is_ear(corner)) {
                corner = next_[cut(corner)];
                refused = 0;
            } else {
                corner = next_[corner];
                ++refused;
            }
        }
        cut(corner);
        return std::move(triangles_);
    }

   private:
    /// A ring that was stuck this often is not worth the time that looking for true ears takes.
    static constexpr int patience = 16;

    double turn(Index i) const {
        return area2(points_[previous_[i]], points_[i], points_[next_[i]]);
    }

    /// Corners where the polygon turns left lie in no ear without another one that does not.
    bool is_ear(Index i) const {
        if (!convex_[i] || times_stuck_ > patience) return convex_[i];
        const glm::dvec2 a = points_[previous_[i]], b = points_[i], c = points_[next_[i]];
        for (Index j = next_[next_[i]]; j != previous_[i]; j = next_[j]) {
            if (convex_[j]) continue;
            const glm::dvec2 p = points_[j];
            if (p != a && p != b && p != c && contains(a, b, c, p)) return false;
        }
        return true;
    }

    /// What to cut from a ring without ears: it crosses or touches itself, or it has no area. A
    /// corner on a straight line if there is one, else the one that turns left the most.
    Index least_bad(Index start) const {
        Index best = start;
        for (Index i = next_[start]; i != start && turn(best) != 0; i = next_[i]) {
            if (turn(i) == 0 || turn(i) > turn(best)) best = i;
        }
        return best;
    }

    /// Takes a corner out of the ring, with its triangle unless that has no area; the next one.
    Index cut(Index i) {
        const Index before = previous_[i], after = next_[i];
        if (turn(i) > 0) triangles_.push_back({before, i, after});
        next_[before] = after;
        previous_[after] = before;
        convex_[before] = turn(before) > 0;
        convex_[after] = turn(after) > 0;
        --left_;
        return after;
    }

    const Points& points_;
    std::vector<Index> previous_, next_;
    std::vector<char> convex_;
    Index left_;
    int times_stuck_ = 0;
    std::vector<Triangle> triangles_;
};

}  // namespace

std::vector<Triangle> triangulate(std::span<const glm::dvec3> corners) {
    if (corners.size() < 3) return {};
    if (corners.size() == 3) return fan(3);
    const Points points = project(corners);
    if (points.empty()) return {};
    if (is_convex(points)) return fan(points.size());
    return EarClipper(points).cut_all();
}

}  // namespace rt
