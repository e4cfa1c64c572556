// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "host/flatten/boxes.h"
#include "host/trace/math.h"
#include "host/trace/scene_view.h"

// Twin of kernels/bvh.cl: which leaves of a hierarchy a ray must look into. Which others it looks
// into, and in which order, changes nothing (closest_hit.h).
namespace rt::trace {

/// A ray as box tests need it. The boxes' planes are moved out by what rounding in the ray's frame
/// may take, which grows with the distance of its origin from 0; subtracting that from a low plane
/// is adding it to the origin.
template <typename T>
struct BoxRay {
    Vec3<T> low_origin, high_origin;  ///< for the boxes' low and high planes
    Vec3<T> inverse;                  ///< 1 / direction, infinite where that is 0
};

template <typename T>
BoxRay<T> make_box_ray(const Ray<T>& ray) {
    const Vec3<T> a = abs3(ray.origin);
    const T slack = T(box_slack) * Flat<T>::roundoff * std::max({a.x, a.y, a.z});
    return {ray.origin + slack, ray.origin - slack, T(1) / ray.dir};
}

/// Narrows near..far to what lies between two planes. The comparisons are such that a NaN (0 times
/// infinity: the origin on a plane, the ray along it) leaves them alone.
template <typename T>
void clip(T low, T high, T low_origin, T high_origin, T inverse, T& near, T& far) {
    const T to_low = (low - low_origin) * inverse;
    const T to_high = (high - high_origin) * inverse;
    const T enter = inverse < T(0) ? to_high : to_low;
    const T leave = inverse < T(0) ? to_low : to_high;
    near = enter > near ? enter : near;
    far = leave < far ? leave : far;
}

/// Where the ray enters the node's box (0 from inside), or NaN if it misses it: a limit may be
/// infinite, and no comparison holds for a NaN.
template <typename T>
T enter_box(const BoxRay<T>& ray, const typename Flat<T>::BvhNode& node) {
    constexpr T widening = T(1) + T(6) * Flat<T>::roundoff;  // 1 + 2 gamma(3), after Ize 2013
    T near = 0, far = std::numeric_limits<T>::infinity();
    clip(node.low.x, node.high.x, ray.low_origin.x, ray.high_origin.x, ray.inverse.x, near, far);
    clip(node.low.y, node.high.y, ray.low_origin.y, ray.high_origin.y, ray.inverse.y, near, far);
    clip(node.low.z, node.high.z, ray.low_origin.z, ray.high_origin.z, ray.inverse.z, near, far);
    return near <= far * widening ? near : std::numeric_limits<T>::quiet_NaN();
}

/// Calls visit(primitive), counted within its kind, for those in every leaf that the ray enters no
/// further away than `limit`, nearer leaves first, until a call returns true; that is returned.
/// `limit` may shrink meanwhile.
template <typename T, typename Visit>
bool visit_leaves(const SceneView<T>& scene, const BoxRay<T>& ray, typename Flat<T>::Index root,
                  const T& limit, const Visit& visit) {
    using Index = typename Flat<T>::Index;
    struct Entry {
        T near;
        Index node;
    };
    std::array<Entry, f32::RT_BVH_STACK> stack;
    std::size_t size = 0;
    Entry next{enter_box(ray, scene.nodes[root]), root};
    for (;;) {
        while (!(next.near <= limit)) {
            if (size == 0) return false;
            next = stack[--size];
        }
        const auto& node = scene.nodes[next.node];
        if (node.count > 0) {
            for (Index i = node.first; i < node.first + node.count; ++i) {
                if (visit(i)) return true;
            }
            next.near = std::numeric_limits<T>::quiet_NaN();
            continue;
        }
        next = {enter_box(ray, scene.nodes[node.first]), node.first};
        Entry other{enter_box(ray, scene.nodes[node.first + 1]), node.first + 1};
        if (other.near < next.near) std::swap(next, other);
        if (other.near <= limit) stack[size++] = other;
    }
}

}  // namespace rt::trace
