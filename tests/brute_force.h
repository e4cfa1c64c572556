// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "host/flatten/flat_scene.h"

// A textbook tracer: every primitive in closed form, in long double, written independently of the
// kernels. Each intersection with a ray's line comes with a bound on the error that rounding in T
// may cause in its distance, and with whether rounding may decide if it exists at all.
namespace rt {

using Wide = long double;
using Wide3 = glm::vec<3, Wide>;

template <typename P>
Wide3 wide(const P& p) {
    return {Wide(p.x), Wide(p.y), Wide(p.z)};
}

struct Meeting {
    Wide t, slack;  ///< distance, and its error bound
    bool is_sure;
    std::int64_t prim;
};

/// A ray with the roundoff of the arithmetic that traces it, and all it may hit.
class BruteForce {
   public:
    template <typename T>
    BruteForce(const FlatScene<T>& scene, const Wide3& origin, const Wide3& dir)
        : origin_(origin), dir_(dir), error_(64 * Wide(Flat<T>::roundoff)) {
        for (const auto& sphere : scene.spheres) meet_sphere(wide(sphere.center), sphere.radius);
        for (const auto& cone : scene.cones) meet_cone(cone);
        for (const auto& triangle : scene.triangles) {
            meet_triangle(wide(triangle.p0), wide(triangle.p1), wide(triangle.p2));
        }
    }

    /// The smallest upper bound on the distance of a sure hit.
    Wide nearest_end() const {
        Wide end = std::numeric_limits<Wide>::infinity();
        for (const Meeting& m : meetings_) end = m.is_sure ? std::min(end, m.t + m.slack) : end;
        return end;
    }
    /// Whether an uncertain hit may lie within this distance.
    bool has_doubt_within(Wide distance) const {
        return std::any_of(meetings_.begin(), meetings_.end(), [&](const Meeting& m) {
            return !m.is_sure && m.t - m.slack <= distance;
        });
    }
    /// Whether a tracer may report this as the nearest hit; nothing is uncertain up to there.
    bool agrees(std::int64_t prim, Wide t) const {
        const Wide end = nearest_end();
        if (prim < 0) return std::isinf(end);
        return std::any_of(meetings_.begin(), meetings_.end(), [&](const Meeting& m) {
            return m.is_sure && m.prim == prim && std::abs(m.t - t) <= m.slack &&
                   m.t - m.slack <= end * (1 + error_);
        });
    }
    /// Whether a hit is uncertain, or lies too close to this distance to say on which side.
    bool is_unsure_at(Wide distance) const {
        if (nearest_end() < distance) return false;
        return std::any_of(meetings_.begin(), meetings_.end(), [&](const Meeting& m) {
            return m.t - m.slack <= distance * (1 + error_);
        });
    }
    bool is_blocked(Wide distance) const { return nearest_end() < distance; }

   private:
    /// Adds a hit at t. `size`: how far from the eye the primitive extends; `steep`: how fast the
    /// ray leaves the surface, per unit length; `clear`: distance from the primitive's boundary.
    void add(Wide t, Wide size, Wide steep, Wide clear) {
        const Wide reach = 2 * (glm::length(origin_) + size);  // no hit can lie beyond it
        const Wide slack = error_ * reach / std::max(steep, error_);
        if (t < -slack || t > reach + slack || clear < -slack) return;
        const bool is_sure = steep > 2 * error_ && t > slack && clear > slack;
        meetings_.push_back({t, slack, is_sure, prim_});
    }

    void meet_sphere(const Wide3& center, Wide r) {
        const Wide3 f = origin_ - center;
        const Wide b = -glm::dot(f, dir_), squared = glm::dot(dir_, dir_);
        const Wide3 closest = f + b / squared * dir_;
        const Wide left = r * r - glm::dot(closest, closest);
        const Wide size = glm::length(center) + r;
        const Wide s = std::sqrt(std::max(left, Wide(0)) / squared);
        if (left > -2 * error_ * r * (size + glm::length(origin_))) {
            // Both ends of the chord, which coincide within rounding error where the ray grazes.
            const Wide steep = left > 0 ? s / r : 0;
            const Wide far_off = std::numeric_limits<Wide>::infinity();
            add(b / squared - s, size, steep * steep, far_off);
            add(b / squared + s, size, steep * steep, far_off);
        }
        ++prim_;
    }

    template <typename C>
    void meet_cone(const C& cone) {
        const Wide3 axis = wide(cone.axis), w = origin_ - wide(cone.base);
        const Wide3 c = glm::cross(dir_, axis), g = glm::cross(w, axis);
        const Wide slope = cone.slope, length = cone.length, base_radius = cone.base_radius;
        const Wide height = glm::dot(w, axis), rise = glm::dot(dir_, axis);
        const Wide radius = base_radius + slope * height, m = slope * rise;
        const Wide a = glm::dot(c, c) - m * m, b = glm::dot(g, c) - radius * m;
        const Wide k = glm::dot(g, g) - radius * radius;
        const Wide widest = std::max(base_radius, base_radius + slope * length);
        const Wide size = glm::length(wide(cone.base)) + length + widest;
        const Wide left = b * b - a * k;
        const Wide grazing = 8 * error_ * widest * (size + glm::length(origin_)) * glm::dot(c, c);
        if (left > -grazing) {
            const Wide s = std::sqrt(std::max(left, Wide(0)));
            for (const Wide t : {(-b - s) / a, (-b + s) / a}) {
                const Wide at = height + t * rise, there = radius + t * m;
                const Wide steep = left > grazing ? std::min(s / widest, Wide(1)) : 0;
                add(t, size, steep * steep, std::min({at, length - at, there}));
            }
        }
        ++prim_;
    }

    void meet_triangle(const Wide3& p0, const Wide3& p1, const Wide3& p2) {
        const Wide3 p[] = {p0 - origin_, p1 - origin_, p2 - origin_};
        const Wide3 n = glm::cross(p[1] - p[0], p[2] - p[0]);
        const Wide facing = glm::dot(dir_, n);
        Wide size = 0, clear = std::numeric_limits<Wide>::infinity();
        for (int i = 0; i < 3; ++i) {
            const Wide3 &from = p[i], &to = p[(i + 1) % 3];
            // How far the ray's line passes inside this edge's line.
            const Wide volume = glm::dot(dir_, glm::cross(from, to)) * (facing < 0 ? -1 : 1);
            clear = std::min(clear, volume / glm::length(glm::cross(dir_, to - from)));
            size = std::max(size, glm::length(p[i]) + glm::length(origin_));
        }
        const Wide t = glm::dot(p[0], n) / facing;
        const Wide steep = std::abs(facing) / glm::length(n);
        if (std::isfinite(t) && std::isfinite(clear)) {
            add(t, size, steep, clear);
        } else {
            meetings_.push_back({0, 2 * size, false, prim_});
        }
        ++prim_;
    }

    const Wide3 origin_, dir_;
    const Wide error_;  ///< 64 roundoffs
    std::int64_t prim_ = 0;
    std::vector<Meeting> meetings_;
};

}  // namespace rt
