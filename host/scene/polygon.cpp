// SPDX-License-Identifier: Apache-2.0
#include "host/scene/polygon.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <utility>

#include "host/scene/geometry.h"

namespace rt {
namespace {

bool before(glm::dvec2 a, glm::dvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

/// Whether the segments cross at interior points of both; touching does not count.
bool properly_cross(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 d) {
    return orientation(a, b, c) * orientation(a, b, d) < 0 &&
           orientation(c, d, a) * orientation(c, d, b) < 0;
}

bool on_one_line(std::span<const glm::dvec3> corners) {
    const glm::dvec3 start = corners[0];
    const glm::dvec3 end = *std::max_element(
        corners.begin(), corners.end(),
        [&](glm::dvec3 a, glm::dvec3 b) { return largest(a - start) < largest(b - start); });
    return std::all_of(corners.begin(), corners.end(), [&](glm::dvec3 corner) {
        return zero_area({start, end, corner});
    });
}

/// Newell's normal (Sutherland, Sproull and Schumacker 1974): its length is twice the area, at an
/// extent of 1.
glm::dvec3 normal_of(std::span<const glm::dvec3> corners) {
    double extent = 0;
    for (const glm::dvec3& corner : corners)
        extent = std::max(extent, largest(corner - corners[0]));
    const auto scaled = [&](const glm::dvec3& corner) { return (corner - corners[0]) / extent; };
    glm::dvec3 normal{0};
    glm::dvec3 before = scaled(corners.back());
    for (const glm::dvec3& corner : corners) {
        const glm::dvec3 p = scaled(corner);
        normal += glm::cross(before, p);
        before = p;
    }
    return normal;
}

/// Projects the polygon along the axis nearest to its normal, counterclockwise. Coordinates are
/// only scaled by powers of two: nothing is rounded.
std::vector<glm::dvec2> flattened(std::span<const glm::dvec3> corners, glm::dvec3 normal) {
    int axis = 0;
    if (std::abs(normal.y) > std::abs(normal[axis])) axis = 1;
    if (std::abs(normal.z) > std::abs(normal[axis])) axis = 2;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(u, v);
    double size = 0;
    for (const glm::dvec3& corner : corners) {
        size = std::max({size, std::abs(corner[u]), std::abs(corner[v])});
    }
    int exponent = 0;
    std::frexp(size, &exponent);
    std::vector<glm::dvec2> flat;
    flat.reserve(corners.size());
    for (const glm::dvec3& corner : corners) {
        flat.emplace_back(std::ldexp(corner[u], -exponent), std::ldexp(corner[v], -exponent));
    }
    return flat;
}

/// Cuts ears (triangles of three neighboring corners that hold no other corner) off a polygon in
/// the plane until nothing is left (Meisters 1975). Every decision is exact; each ear has a
/// positive area, so that the triangles add up to the polygon and none lies outside it.
class EarClipper {
   public:
    EarClipper(std::vector<glm::dvec2> points, std::int64_t work,
               std::vector<std::array<std::uint32_t, 3>>& triangles)
        : points_(std::move(points)),
          previous_(points_.size()),
          next_(points_.size()),
          alive_(points_.size(), 1),
          repeated_(points_.size(), 0),
          work_(work),
          triangles_(triangles) {}

    /// Returns whether the triangles are the polygon.
    bool run() {
        link();
        tidy_all();
        if (count_ < 3) return true;
        if (is_strictly_convex()) {
            for (Index i = next_[start_]; next_[i] != start_; i = next_[i]) {
                triangles_.push_back({start_, i, next_[i]});
            }
            return true;
        }
        if (edges_cross()) return false;
        find_obstacles();
        clip();
        return work_ >= 0 && count_ < 3;
    }

   private:
    using Index = std::uint32_t;

    /// Makes a ring of all corners.
    void link() {
        count_ = static_cast<Index>(points_.size());
        for (Index i = 0; i < count_; ++i) {
            previous_[i] = (i + count_ - 1) % count_;
            next_[i] = (i + 1) % count_;
        }
    }

    /// Removes duplicates of the next corner, and the tips of spikes.
    void tidy_all() {
        Index corner = start_;
        for (Index kept = 0; kept < count_ && count_ > 2;) {
            if (!is_idle(corner)) {
                corner = next_[corner];
                ++kept;
                continue;
            }
            const Index last = previous_[corner];
            cut(corner);
            corner = last;
            kept = kept > 0 ? kept - 1 : 0;
        }
    }

    /// The same near one corner, after its neighbor was cut. Returns a remaining corner.
    Index tidy(Index corner) {
        while (count_ > 2) {
            const Index last = previous_[corner];
            if (is_idle(corner)) {
                cut(corner);
                corner = last;
            } else if (is_idle(last)) {
                cut(last);
            } else {
                break;
            }
        }
        return corner;
    }

    bool is_idle(Index corner) const {
        const glm::dvec2 a = points_[previous_[corner]], b = points_[corner];
        const glm::dvec2 c = points_[next_[corner]];
        return b == c || (before(a, b) == before(c, b) && orientation(a, b, c) == 0);
    }

    /// Every turn is to the left, and it winds once: the (x, y) order rises once and falls once.
    bool is_strictly_convex() const {
        int reversals = 0;
        for (Index i = next_[start_], seen = 0; seen < count_; i = next_[i], ++seen) {
            if (turn(i) <= 0) return false;
            const bool rose = before(points_[previous_[i]], points_[i]);
            const bool rises = before(points_[i], points_[next_[i]]);
            reversals += rose != rises;
        }
        return reversals == 2;
    }

    /// Sweeps over edges sorted by low x, testing each against those that start before it ends.
    bool edges_cross() {
        struct Edge {
            glm::dvec2 a, b, low, high;
        };
        std::vector<Edge> edges;
        edges.reserve(count_);
        for (Index i = start_, seen = 0; seen < count_; i = next_[i], ++seen) {
            const glm::dvec2 a = points_[i], b = points_[next_[i]];
            edges.push_back({a, b, glm::min(a, b), glm::max(a, b)});
        }
        std::ranges::sort(edges, {}, [](const Edge& edge) { return edge.low.x; });
        for (std::size_t i = 0; i < edges.size() && work_ >= 0; ++i) {
            const Edge& e = edges[i];
            for (std::size_t j = i + 1; j < edges.size() && edges[j].low.x <= e.high.x; ++j) {
                const Edge& f = edges[j];
                --work_;
                if (f.high.y < e.low.y || f.low.y > e.high.y) continue;
                if (properly_cross(e.a, e.b, f.a, f.b)) return true;
            }
        }
        return work_ < 0;
    }

    /// If any corner lies in a triangle of three neighbors, so does one with a turn not to the
    /// left. Coincident corners count too: the polygon pinches there. Sorted by x.
    void find_obstacles() {
        std::vector<Index> order;
        for (Index i = 0; i < alive_.size(); ++i) {
            if (alive_[i]) order.push_back(i);
        }
        std::sort(order.begin(), order.end(),
                  [&](Index a, Index b) { return before(points_[a], points_[b]); });
        for (std::size_t i = 1; i < order.size(); ++i) {
            if (points_[order[i - 1]] != points_[order[i]]) continue;
            repeated_[order[i - 1]] = repeated_[order[i]] = 1;
        }
        std::copy_if(order.begin(), order.end(), std::back_inserter(obstacles_),
                     [&](Index i) { return repeated_[i] || turn(i) <= 0; });
    }

    /// Corners on an ear's boundary block it, so that they become corners of triangles, unless that
    /// leaves no ear. What then remains is flat or folded. The first round never cuts two neighbors
    /// in a row, which would make fans of slivers.
    void clip() {
        clip_round(true, true);
        while (count_ > 2 && work_ >= 0) {
            if (clip_round(true, false) || clip_round(false, false) || drop_flat_corner()) continue;
            return;
        }
    }

    /// Goes around the ring once and cuts the ears. Returns whether there were any.
    bool clip_round(bool strict, bool skip) {
        bool any = false;
        Index corner = start_;
        work_ -= count_ + static_cast<std::int64_t>(obstacles_.size());
        for (Index left = count_; left > 0 && count_ > 2 && work_ >= 0; --left) {
            const Index following = next_[corner];
            if (turn(corner) > 0 && is_ear(corner, strict)) {
                cut(corner);
                any = true;
                corner = tidy(following);
                if (skip) corner = next_[corner];
                if (!strict) return true;
                continue;
            }
            corner = following;
        }
        std::erase_if(obstacles_,
                      [&](Index i) { return !alive_[i] || (!repeated_[i] && turn(i) > 0); });
        return any;
    }

    bool drop_flat_corner() {
        for (Index i = start_, seen = 0; seen < count_; i = next_[i], ++seen) {
            if (turn(i) != 0) continue;
            work_ -= seen;
            cut(i);
            return true;
        }
        return false;
    }

    /// Each corner leaves a triangle, so that a polygon that is not flat loses nothing where it has
    /// no area in the projection.
    void cut(Index corner) {
        triangles_.push_back({previous_[corner], corner, next_[corner]});
        next_[previous_[corner]] = next_[corner];
        previous_[next_[corner]] = previous_[corner];
        alive_[corner] = 0;
        if (start_ == corner) start_ = next_[corner];
        --count_;
    }

    bool is_ear(Index corner, bool strict) {
        const glm::dvec2 a = points_[previous_[corner]], b = points_[corner];
        const glm::dvec2 c = points_[next_[corner]];
        const glm::dvec2 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
        auto other = std::lower_bound(obstacles_.begin(), obstacles_.end(), low.x,
                                      [&](Index i, double x) { return points_[i].x < x; });
        for (; other != obstacles_.end() && points_[*other].x <= high.x; ++other) {
            --work_;
            const double y = points_[*other].y;
            if (y >= low.y && y <= high.y && blocks(*other, corner, strict)) return false;
        }
        return true;
    }

    bool blocks(Index other, Index corner, bool strict) const {
        if (!alive_[other]) return false;
        const Index last = previous_[corner], next = next_[corner];
        if (other == last || other == corner || other == next) return false;
        const glm::dvec2 point = points_[other];
        if (point == points_[last] || point == points_[corner] || point == points_[next]) {
            return pinches(other, corner);
        }
        return inside(point, corner, strict);
    }

    /// Whether an edge at a corner that coincides with one of the ear's passes through the ear.
    bool pinches(Index other, Index corner) const {
        const glm::dvec2 a = points_[previous_[corner]], b = points_[next_[corner]];
        for (const Index end : {previous_[other], next_[other]}) {
            if (inside(points_[end], corner, false)) return true;
            if (properly_cross(points_[other], points_[end], a, b)) return true;
        }
        return false;
    }

    int turn(Index corner) const {
        return orientation(points_[previous_[corner]], points_[corner], points_[next_[corner]]);
    }

    /// Whether a point lies in the triangle at a corner; `strict` includes its boundary.
    bool inside(glm::dvec2 point, Index corner, bool strict) const {
        const glm::dvec2 a = points_[previous_[corner]], b = points_[corner];
        const glm::dvec2 c = points_[next_[corner]];
        const int least = strict ? 0 : 1;
        return orientation(a, b, point) >= least && orientation(b, c, point) >= least &&
               orientation(c, a, point) >= least;
    }

    std::vector<glm::dvec2> points_;
    std::vector<Index> previous_, next_;
    std::vector<char> alive_;
    std::vector<char> repeated_;    ///< shares its place with another corner
    std::vector<Index> obstacles_;  ///< corners that may stand in an ear's way
    Index start_ = 0, count_ = 0;   ///< a corner that is left, and how many are
    std::int64_t work_;             ///< comparisons left
    std::vector<std::array<std::uint32_t, 3>>& triangles_;
};

constexpr PolygonBlemish no_area{{"polygon ignored", "polygons ignored"},
                                 "zero-area polygon; remove it"};
constexpr PolygonBlemish not_simple{
    {"polygon split as a fan", "polygons split as fans"},
    "the polygon is self-intersecting or too complex and may look wrong; split it"};

/// Returns whether the triangles are exact.
bool triangulate(std::span<const glm::dvec3> corners, std::int64_t work,
                 std::vector<std::array<std::uint32_t, 3>>& triangles) {
    if (corners.size() == 3) triangles.push_back({0, 1, 2});
    if (corners.size() > 3 && !on_one_line(corners)) {
        const glm::dvec3 normal = normal_of(corners);
        if (largest(normal) == 0) return false;
        if (!EarClipper(flattened(corners, normal), work, triangles).run()) return false;
    }
    std::erase_if(triangles, [&](const auto& triangle) {
        return zero_area({corners[triangle[0]], corners[triangle[1]], corners[triangle[2]]});
    });
    return true;
}

}  // namespace

const PolygonBlemish* split_polygon(std::span<const glm::dvec3> corners, std::size_t file_bytes,
                                    std::vector<std::array<std::uint32_t, 3>>& triangles) {
    triangles.clear();
    // So many for each corner bound the time for the whole file, and let a small one be intricate.
    const std::int64_t each =
        256 + (std::int64_t{1} << 32) / (static_cast<std::int64_t>(file_bytes) + 1);
    const std::int64_t work = each * static_cast<std::int64_t>(corners.size());
    if (triangulate(corners, work, triangles)) return triangles.empty() ? &no_area : nullptr;
    triangles.clear();
    for (std::uint32_t i = 2; i < corners.size(); ++i) triangles.push_back({0, i - 1, i});
    return &not_simple;
}

}  // namespace rt
