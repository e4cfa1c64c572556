// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "host/trace/hit_surface.h"

// What travels between the kernel tests and tests/probes.cl besides the shared structs, and short
// ways to make it.
namespace rt {

template <typename T>
using Packed3 = typename Flat<T>::Packed3;

template <typename T>
struct ProbeRay {
    Packed3<T> origin;
    T t_max;
    Packed3<T> dir;
    typename Flat<T>::Index from;
    T chord;
    Packed3<T> dir_low{}, origin_low{};
};

template <typename T>
struct ProbeSurface {
    Packed3<T> point;
    T offset;
    Packed3<T> normal;
    typename Flat<T>::Index material;
    Packed3<T> geometric;
    T diameter;
    Packed3<T> point_low{};
};

template <typename T>
Packed3<T> pack(const glm::vec<3, T>& v) {
    return {v.x, v.y, v.z};
}

template <typename T>
Packed3<T> round_to(const glm::dvec3& v) {
    return {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)};
}

template <typename T>
ProbeRay<T> pack(const trace::Ray<T>& ray) {
    return {pack(ray.origin), ray.t_max,         pack(ray.dir),       ray.from,
            ray.chord,        pack(ray.dir_low), pack(ray.origin_low)};
}
template <typename T>
trace::Ray<T> unpack(const ProbeRay<T>& ray) {
    return {trace::load3(ray.origin),  trace::load3(ray.dir),       ray.t_max, ray.from, ray.chord,
            trace::load3(ray.dir_low), trace::load3(ray.origin_low)};
}

template <typename T>
ProbeSurface<T> pack(const trace::Surface<T>& s) {
    return {pack(s.point),     s.offset,   pack(s.normal),   s.material,
            pack(s.geometric), s.diameter, pack(s.point_low)};
}
template <typename T>
trace::Surface<T> unpack(const ProbeSurface<T>& s) {
    return {trace::load3(s.point),
            trace::load3(s.point_low),
            trace::load3(s.normal),
            trace::load3(s.geometric),
            s.offset,
            s.diameter,
            s.material};
}

/// An endless ray from nowhere in particular; its direction is made unit in double and rounded.
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

/// f(0) .. f(count - 1): what a twin makes of the same items.
template <typename F>
auto for_each_item(std::size_t count, F f) {
    std::vector<decltype(f(std::size_t(0)))> results;
    results.reserve(count);
    for (std::size_t i = 0; i < count; ++i) results.push_back(f(i));
    return results;
}

}  // namespace rt
