// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

#include "host/flatten/flat_types.h"

// Twin of kernels/math.cl: the same functions in the same order of operations. Compiled without
// contraction (CMakeLists.txt), so that both round alike.
/// For the small functions that the tracer's inner loops are made of: compilers stop inlining them
/// once a caller has grown large.
#define RT_INLINE [[gnu::always_inline]] inline

namespace rt::trace {

template <typename P>
RT_INLINE auto load3(const P& p) {
    return Vec3<decltype(p.x)>(p.x, p.y, p.z);
}

template <typename T>
RT_INLINE T min_of(T a, T b) {
    return a < b ? a : b;
}

template <typename T>
RT_INLINE T max_of(T a, T b) {
    return a > b ? a : b;
}

template <typename T>
RT_INLINE T dot3(const Vec3<T>& a, const Vec3<T>& b) {
    return std::fma(a.z, b.z, std::fma(a.y, b.y, a.x * b.x));
}

/// a + s * b
template <typename T>
RT_INLINE Vec3<T> add_scaled(const Vec3<T>& a, T s, const Vec3<T>& b) {
    return {std::fma(s, b.x, a.x), std::fma(s, b.y, a.y), std::fma(s, b.z, a.z)};
}

/// a + s b less its rounded value `sum`, all but exactly (Knuth's sum and the product by fma).
template <typename T>
RT_INLINE T lost(T a, T s, T b, T sum) {
    const T product = s * b;
    const T product_low = std::fma(s, b, -product);
    const T total = a + product;
    const T taken = total - a;
    const T total_low = (a - (total - taken)) + (product - taken);
    return (total - sum) + (total_low + product_low);
}

/// What add_scaled(a, s, b) has lost by rounding to `sum`.
template <typename T>
RT_INLINE Vec3<T> lost3(const Vec3<T>& a, T s, const Vec3<T>& b, const Vec3<T>& sum) {
    return {lost(a.x, s, b.x, sum.x), lost(a.y, s, b.y, sum.y), lost(a.z, s, b.z, sum.z)};
}

template <typename T>
RT_INLINE T length3(const Vec3<T>& v) {
    return std::sqrt(dot3(v, v));
}

template <typename T>
RT_INLINE Vec3<T> normalize3(const Vec3<T>& v) {
    return v * (T(1) / length3(v));
}

template <typename T>
RT_INLINE Vec3<T> abs3(const Vec3<T>& v) {
    return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)};
}

/// a b - c d with an error below 1.5 ulp (Kahan; Jeannerod, Louvet and Muller 2013).
template <typename T>
RT_INLINE T difference_of_products(T a, T b, T c, T d) {
    const T cd = c * d;
    return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

/// The mirror direction of d (towards the surface) about the unit normal n.
template <typename T>
RT_INLINE Vec3<T> reflect3(const Vec3<T>& d, const Vec3<T>& n) {
    return add_scaled(d, T(-2) * dot3(d, n), n);
}

/// Infinite components become the largest number, so that times 0 they are 0.
template <typename T>
Vec3<T> limit3(const Vec3<T>& v) {
    constexpr T largest = std::numeric_limits<T>::max();
    return {v.x < largest ? v.x : largest, v.y < largest ? v.y : largest,
            v.z < largest ? v.z : largest};
}

}  // namespace rt::trace
