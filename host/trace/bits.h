// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <limits>

#include "host/flatten/flat_types.h"

// Twin of kernels/bits.cl: numbers as bits.
namespace rt::trace {

template <typename T>
struct Bits {
    using Index = typename Flat<T>::Index;
    static constexpr int mantissa_bits = std::numeric_limits<T>::digits - 1;
    static constexpr Index binade = Index(1) << mantissa_bits;
};

/// The next number above x (direction > 0), below it (direction < 0), or x (direction == 0).
template <typename T>
T one_ulp_towards(T x, T direction) {
    using Index = typename Flat<T>::Index;
    if (direction == T(0)) return x;
    const T smallest = std::numeric_limits<T>::denorm_min();
    if (x == T(0)) return direction > T(0) ? smallest : -smallest;
    const bool away_from_zero = (x > T(0)) == (direction > T(0));
    return std::bit_cast<T>(std::bit_cast<Index>(x) + Index(away_from_zero ? 1 : -1));
}

}  // namespace rt::trace
