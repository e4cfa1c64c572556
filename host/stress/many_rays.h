// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <mutex>
#include <numbers>
#include <random>
#include <type_traits>
#include <vector>

#include "host/base/parallel.h"
#include "host/render/renderer.h"
#include "host/stress/stress_case.h"

// Helpers for trials with many random rays.
namespace rt {

/// A trial that runs count<T>(rays, caster), a generic lambda over T, in float and in double.
template <typename Count>
RayTrial both_precisions(const Count& count) {
    return {[=](std::uint64_t rays, const RayCaster& caster, Precision precision) {
        return precision == Precision::float64 ? count.template operator()<double>(rays, caster)
                                               : count.template operator()<float>(rays, caster);
    }};
}

/// Random numbers, the same on every machine.
class RandomNumbers {
   public:
    explicit RandomNumbers(std::uint64_t seed) : engine_(seed) {}

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

/// `dir`, of any length, normalized, rounded to T and normalized again in T.
template <typename T>
typename Flat<T>::Packed3 rounded_unit(const glm::dvec3& dir) {
    const auto d = pack<T>(dir / glm::length(dir));
    const T inverse = T(1) / std::sqrt(std::fma(d.z, d.z, std::fma(d.y, d.y, d.x * d.x)));
    return {inverse * d.x, inverse * d.y, inverse * d.z};
}

/// An endless ray.
template <typename T>
typename Flat<T>::RayQuery ray_query(const glm::dvec3& origin, const glm::dvec3& dir) {
    typename Flat<T>::RayQuery query{};
    query.origin = pack<T>(origin);
    query.dir = rounded_unit<T>(dir);
    query.t_max = std::numeric_limits<T>::infinity();
    query.from = Flat<T>::none;
    return query;
}

/// Traces many rays and sums up the results. make(random) returns a query; continue_ray(random,
/// query, answer) may set the direction of a secondary ray from the hit (nullptr: none);
/// judge(query, answer, figures) counts. Each block of rays has its own numbers, so that the rays
/// are the same on any number of cores.
template <typename T, typename Make, typename Continue, typename Judge>
RayFigures many_rays(const RayTracer<T>& trace, std::uint64_t rays, const Make& make,
                     const Continue& continue_ray, const Judge& judge) {
    constexpr std::size_t block = 4096, batch = 16 * block;
    std::vector<typename Flat<T>::RayQuery> queries;
    std::vector<typename Flat<T>::RayAnswer> answers;
    RayFigures sum;
    std::mutex mutex;
    for (std::uint64_t at = 0; at < rays; at += batch) {
        const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(rays - at, batch));
        std::vector<RandomNumbers> random;
        for (std::size_t i = 0; i < count; i += block) random.emplace_back(at + i + 1);
        queries.resize(count);
        answers.resize(count);
        const auto in_blocks = [&](const auto& work) {
            for_each_run(count, block, available_cores(), [&](std::size_t first, std::size_t last) {
                work(random[first / block], first, last);
            });
        };
        in_blocks([&](RandomNumbers& own, std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) queries[i] = make(own);
        });
        trace(queries, answers);
        if constexpr (!std::is_null_pointer_v<Continue>) {
            in_blocks([&](RandomNumbers& own, std::size_t first, std::size_t last) {
                for (std::size_t i = first; i < last; ++i)
                    continue_ray(own, queries[i], answers[i]);
            });
            trace(queries, answers);
        }
        in_blocks([&](RandomNumbers&, std::size_t first, std::size_t last) {
            RayFigures own;
            for (std::size_t i = first; i < last; ++i) judge(queries[i], answers[i], own);
            const std::lock_guard lock(mutex);
            sum.rays += own.rays;
            sum.failures += own.failures;
            sum.max_error = std::max(sum.max_error, own.max_error);
        });
    }
    return sum;
}

/// A random direction at this angle above a surface with this normal.
inline glm::dvec3 at_angle(RandomNumbers& random, const glm::dvec3& normal, double angle) {
    const glm::dvec3 other = std::fabs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 across = glm::normalize(glm::cross(normal, other));
    const double turn = random.uniform(0, 2 * std::numbers::pi);
    const glm::dvec3 tangent =
        std::cos(turn) * across + std::sin(turn) * glm::cross(normal, across);
    return std::cos(angle) * tangent + std::sin(angle) * normal;
}

/// Whether the ray was continued.
template <typename T>
bool has_left(const typename Flat<T>::RayQuery& query) {
    return glm::length(in_double(query.next)) > 0;
}
}  // namespace rt
