// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "host/flatten/flat_types.h"
#include "kernels/probes/probe_fields.h"

// The structs passed between the kernel tests and the probes besides the shared ones
// (kernels/probes/probe_structs.h), and short ways to make them.
namespace rt {

template <typename T>
using Packed3 = typename Flat<T>::Packed3;

template <typename T>
using Index = typename Flat<T>::Index;

/// What is in memory for each kind of value of the probes.
template <typename T>
struct ProbeKind {
    using REALS = T;
    using REAL3 = Packed3<T>;
    using INDICES = Index<T>;
    using MASK = Index<T>;
};

#define PROBE_MEMBER(kind, name) typename ProbeKind<T>::kind name{};
template <typename T>
struct ProbeRay {
    PROBE_RAY(PROBE_MEMBER)
};

template <typename T>
struct ProbeSurface {
    PROBE_SURFACE(PROBE_MEMBER)
};

template <typename T>
struct ProbeHit {
    PROBE_HIT(PROBE_MEMBER)
};

/// An unbounded ray that leaves no surface; its direction is normalized in double and rounded.
template <typename T>
ProbeRay<T> make_ray(const glm::dvec3& origin, const glm::dvec3& dir) {
    const double size = std::sqrt(dir.x * dir.x + dir.y * dir.y + dir.z * dir.z);
    return {pack<T>(origin), std::numeric_limits<T>::infinity(), pack<T>(dir / size),
            Flat<T>::none};
}

/// `count` values from make().
template <typename Make>
auto many(std::size_t count, Make make) {
    std::vector<decltype(make())> values(count);
    for (auto& value : values) value = make();
    return values;
}

/// f(0) .. f(count - 1).
template <typename F>
auto for_each_item(std::size_t count, F f) {
    std::vector<decltype(f(std::size_t(0)))> results;
    results.reserve(count);
    for (std::size_t i = 0; i < count; ++i) results.push_back(f(i));
    return results;
}

}  // namespace rt
