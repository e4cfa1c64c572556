// SPDX-License-Identifier: Apache-2.0
#include "host/flatten/boxes.h"

#include <algorithm>
#include <cmath>

namespace rt {

namespace {

/// The box from low to high, enlarged. Adding 0 turns -0 into 0, so that a minimum of several
/// boxes has the same bits in any order.
template <typename T>
BvhBox<T> enlarged(const Vec3<T>& low, const Vec3<T>& high) {
    T largest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        largest = std::max({largest, std::fabs(low[axis]), std::fabs(high[axis])});
    }
    const T slack = T(box_slack) * Flat<T>::roundoff * largest;
    BvhBox<T> box{};
    box.low = {low.x - slack + T(0), low.y - slack + T(0), low.z - slack + T(0)};
    box.high = {high.x + slack + T(0), high.y + slack + T(0), high.z + slack + T(0)};
    return box;
}

template <typename T>
Vec3<T> unpacked(const typename Flat<T>::Packed3& p) {
    return {p.x, p.y, p.z};
}

}  // namespace

template <typename T>
BvhBox<T> box_of(const typename Flat<T>::Sphere& sphere) {
    const Vec3<T> center = unpacked<T>(sphere.center);
    return enlarged<T>(center - sphere.radius, center + sphere.radius);
}

template <typename T>
BvhBox<T> box_of(const typename Flat<T>::Cone& cone) {
    const Vec3<T> base = unpacked<T>(cone.base), axis = unpacked<T>(cone.axis);
    const Vec3<T> end = base + cone.length * axis;
    const T end_radius = cone.apex_radius;
    Vec3<T> low, high;
    for (int i = 0; i < 3; ++i) {
        // A disc's half-width along an axis, slightly more than sqrt(1 - a^2) rounds to.
        const T width = std::sqrt(std::max(T(0), T(1) - axis[i] * axis[i]) + 8 * Flat<T>::roundoff);
        low[i] = std::min(base[i] - cone.base_radius * width, end[i] - end_radius * width);
        high[i] = std::max(base[i] + cone.base_radius * width, end[i] + end_radius * width);
    }
    return enlarged<T>(low, high);
}

template <typename T>
BvhBox<T> box_of(const typename Flat<T>::Packed3& a, const typename Flat<T>::Packed3& b,
                 const typename Flat<T>::Packed3& c) {
    return enlarged<T>(
        {std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})},
        {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})});
}

template f32::BvhNode box_of<float>(const f32::Sphere&);
template f32::BvhNode box_of<float>(const f32::Cone&);
template f32::BvhNode box_of<float>(const f32::Packed3&, const f32::Packed3&, const f32::Packed3&);
template f64::BvhNode box_of<double>(const f64::Sphere&);
template f64::BvhNode box_of<double>(const f64::Cone&);
template f64::BvhNode box_of<double>(const f64::Packed3&, const f64::Packed3&, const f64::Packed3&);

}  // namespace rt
