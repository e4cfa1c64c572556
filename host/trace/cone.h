// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/trace/intersect.h"

// Twin of kernels/cone.cl: a ray against the side of a cone's frustum; the method is described
// there.
namespace rt::trace {

template <typename T>
RT_INLINE Vec3<T> cross3(const Vec3<T>& a, const Vec3<T>& b) {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}

/// How far along the ray to move before solving.
template <typename T>
RT_INLINE T cone_shift(const Ray<T>& ray, const Vec3<T>& w, const Vec3<T>& g, const Vec3<T>& c,
                       const typename Flat<T>::Cone& cone) {
    const T reach = std::fma(std::fabs(cone.slope), cone.length, cone.base_radius) + cone.length;
    const T middle = -dot3(add_scaled(w, T(-0.5) * cone.length, load3(cone.axis)), ray.dir);
    const T nearest = -(dot3(g, c) / dot3(c, c));
    return max_of(middle - reach, min_of(nearest, middle + reach));
}

/// Whether the ray starts on cone number prim.
template <typename T>
RT_INLINE bool leaves_cone(const Ray<T>& ray, const typename Flat<T>::Cone& cone,
                           typename Flat<T>::Index prim) {
    return ray.from == prim || (cone.touches_eye != 0 && ray.from == Flat<T>::eye);
}

/// Distance along the ray to the cone, or -1. `leaving`: the origin lies on this very cone.
template <typename T>
RT_INLINE T intersect_cone(const Ray<T>& ray, const typename Flat<T>::Cone& cone, bool leaving) {
    const Vec3<T> axis = load3(cone.axis);
    const Vec3<T> w = ray.origin - load3(cone.base);
    const Vec3<T> c = cross3(ray.dir, axis);
    Vec3<T> g = cross3(w, axis);
    const T shift = leaving ? T(0) : cone_shift(ray, w, g, c, cone);
    g = add_scaled(g, shift, c);
    const Vec3<T> x = cross3(g, c);
    const T rise = dot3(ray.dir, axis);
    const T height = std::fma(shift, rise, dot3(w, axis));
    const T radius = std::fma(cone.slope, height, cone.base_radius);
    const T m = cone.slope * rise;
    const Vec3<T> v = add_scaled(radius * c, -m, g);
    const T discriminant = dot3(v, v) - dot3(x, x);
    if (!(discriminant >= T(0)) && !leaving) return T(-1);
    const T size = length3(c);
    const T a = (size - m) * (size + m);
    const T b = std::fma(-radius, m, dot3(g, c));
    const T distance = length3(g);
    const T k = (distance - radius) * (distance + radius);
    const T root = std::sqrt(discriminant);
    const T chord = ray.from == Flat<T>::eye ? T(-2) * b : ray.chord;
    const T q = leaving ? chord : -(b + (b < T(0) ? -root : root));
    const T one = q / a;
    const T other = leaving || q == T(0) ? one : k / q;
    const auto counts = [&](T at) {
        const T height_there = std::fma(at, rise, height);
        return shift + at > T(0) && height_there >= T(0) && height_there <= cone.length &&
               std::fma(at, m, radius) >= T(0);
    };
    const T near = min_of(one, other);
    const T far = max_of(one, other);
    if (counts(near)) return shift + near;
    return counts(far) ? shift + far : T(-1);
}

}  // namespace rt::trace
