// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <glm/vec3.hpp>

// Vectors of wide reals for the reference: __float128 (113 bits) or long double (64 bits), both
// with 15 bits of exponent. Nothing here is shared with the renderers.
namespace rt::stress {

using Quad = __float128;

template <typename R>
using Wide3 = glm::vec<3, R>;

// In place of GLM's, which refuse __float128.

template <typename R>
R dot(const Wide3<R>& a, const Wide3<R>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename R>
Wide3<R> cross(const Wide3<R>& a, const Wide3<R>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename R>
R magnitude(R x) {
    return x < 0 ? -x : x;
}

/// Newton's step from the long double root: 64 bits become 113.
template <typename R>
R square_root(R x) {
    if (!(x > 0)) return 0;
    const R root = std::sqrt(static_cast<long double>(x));
    return (root + x / root) / 2;
}
template <typename R>
R length(const Wide3<R>& a) {
    return square_root(dot(a, a));
}
template <typename R>
Wide3<R> unit(const Wide3<R>& a) {
    return (R(1) / length(a)) * a;
}

}  // namespace rt::stress
