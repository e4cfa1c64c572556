// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <mutex>
#include <numbers>
#include <random>

#include "host/parallel.h"
#include "host/stress/stress_case.h"
#include "host/stress/wide_real.h"
#include "host/trace/surface.h"

// What trials with many random rays have in common.
namespace rt {

/// Random numbers, the same everywhere.
class Dice {
   public:
    explicit Dice(std::uint64_t seed) : engine_(seed) {}

    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    double log_uniform(double low, double high) {
        return std::exp(uniform(std::log(low), std::log(high)));
    }
    std::size_t index(std::size_t count) { return engine_() % count; }
    glm::dvec3 direction() {
        const double z = uniform(-1, 1), angle = uniform(0, 2 * std::numbers::pi);
        const double radius = std::sqrt(1 - z * z);
        return {radius * std::cos(angle), radius * std::sin(angle), z};
    }

   private:
    std::mt19937_64 engine_;
};

template <typename P>
glm::dvec3 in_double(const P& p) {
    return {double(p.x), double(p.y), double(p.z)};
}

/// The unit direction along dir, which may have any length, as the tracer rounds it.
template <typename T>
Vec3<T> rounded_unit(const glm::dvec3& dir) {
    return trace::normalize3(Vec3<T>(dir / glm::length(dir)));
}

template <typename T>
trace::Ray<T> make_ray(const Vec3<T>& origin, const glm::dvec3& dir) {
    trace::Ray<T> ray;
    ray.origin = origin;
    ray.dir = rounded_unit<T>(dir);
    ray.t_max = std::numeric_limits<T>::infinity();
    ray.from = Flat<T>::none;
    return ray;
}

/// Sums try_ray(dice, figures) over many rays, in blocks with dice of their own, on all cores.
template <typename Try>
RayFigures many_rays(std::uint64_t rays, const Try& try_ray) {
    constexpr std::uint64_t block = 4096;
    std::atomic<std::uint64_t> next = 0;
    std::mutex mutex;
    RayFigures sum;
    run_on_threads(available_cores(), [&](int) {
        RayFigures own;
        for (std::uint64_t at = next.fetch_add(block); at < rays; at = next.fetch_add(block)) {
            Dice dice(at + 1);
            for (std::uint64_t i = at; i < std::min(at + block, rays); ++i) try_ray(dice, own);
        }
        const std::lock_guard lock(mutex);
        sum.rays += own.rays;
        sum.failures += own.failures;
        sum.max_error = std::max(sum.max_error, own.max_error);
    });
    return sum;
}

template <typename V>
stress::Wide3<stress::Quad> in_quad(const V& v) {
    using stress::Quad;
    return {Quad(v.x), Quad(v.y), Quad(v.z)};
}

/// A direction at this angle over the plane of the normal.
inline glm::dvec3 at_angle(Dice& dice, const glm::dvec3& normal, double angle) {
    const glm::dvec3 other = std::fabs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 across = glm::normalize(glm::cross(normal, other));
    const double turn = dice.uniform(0, 2 * std::numbers::pi);
    const glm::dvec3 tangent =
        std::cos(turn) * across + std::sin(turn) * glm::cross(normal, across);
    return std::cos(angle) * tangent + std::sin(angle) * normal;
}

inline double relative_error(double found, stress::Quad exact) {
    return static_cast<double>(stress::magnitude((stress::Quad(found) - exact) / exact));
}

/// Counts a ray: whether it hit, at t, and at which distance it should have; `exact` is not
/// positive for a miss. A failure is a false hit, a lost one, or a relative error above the
/// tolerance.
inline void note_hit(RayFigures& figures, bool found, double t, stress::Quad exact,
                     double tolerance = std::numeric_limits<double>::infinity()) {
    const bool expected = exact > 0;
    const double error = found && expected ? relative_error(t, exact) : 0;
    ++figures.rays;
    figures.failures += found == expected && error <= tolerance ? 0 : 1;
    figures.max_error = std::max(figures.max_error, error);
}

}  // namespace rt
