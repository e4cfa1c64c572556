// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "host/flatten/flat_types.h"

// The structs passed between the kernel tests and the probes besides the shared ones
// (tests/probe_structs.h), and short ways to make them.
namespace rt {

template <typename T>
using Packed3 = typename Flat<T>::Packed3;

template <typename T>
using Index = typename Flat<T>::Index;

template <typename T>
struct ProbeRay {
    Packed3<T> origin;
    T t_max;
    Packed3<T> dir;
    Index<T> from;
    T self_hit;
    Packed3<T> dir_low{}, origin_low{};
};

template <typename T>
struct ProbeSurface {
    Packed3<T> point;
    T offset;
    Packed3<T> normal;
    Index<T> material;
    Packed3<T> geometric;
    T diameter;
    Packed3<T> point_low{};
};

template <typename T>
struct ProbeHit {
    T t, u, v;
    Index<T> prim, tied;
};

template <typename T>
Packed3<T> round_to(const glm::dvec3& v) {
    return {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)};
}

/// An unbounded ray that leaves no surface; its direction is normalized in double and rounded.
template <typename T>
ProbeRay<T> make_ray(const glm::dvec3& origin, const glm::dvec3& dir) {
    const double size = std::sqrt(dir.x * dir.x + dir.y * dir.y + dir.z * dir.z);
    return {round_to<T>(origin),
            std::numeric_limits<T>::infinity(),
            round_to<T>(dir / size),
            Flat<T>::none,
            0,
            {},
            {}};
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
