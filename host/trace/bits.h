// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <limits>

#include "host/flatten/flat_types.h"

// Twin of kernels/bits.cl: numbers taken apart.
namespace rt::trace {

template <typename T>
struct Bits {
    using Index = typename Flat<T>::Index;
    static constexpr int mantissa_bits = std::numeric_limits<T>::digits - 1;
    static constexpr Index bias = std::numeric_limits<T>::max_exponent - 1;
};

/// x = mantissa_of(x) * 2^exponent_of(x) for normal x > 0; the mantissa is in [1, 2).
template <typename T>
typename Flat<T>::Index exponent_of(T x) {
    using Index = typename Flat<T>::Index;
    return (std::bit_cast<Index>(x) >> Bits<T>::mantissa_bits) - Bits<T>::bias;
}

template <typename T>
T mantissa_of(T x) {
    using Index = typename Flat<T>::Index;
    const Index fraction =
        std::bit_cast<Index>(x) & ((Index(1) << Bits<T>::mantissa_bits) - Index(1));
    return std::bit_cast<T>(fraction | (Bits<T>::bias << Bits<T>::mantissa_bits));
}

/// 2^k for a normal result
template <typename T>
T power_of_two(typename Flat<T>::Index k) {
    return std::bit_cast<T>((k + Bits<T>::bias) << Bits<T>::mantissa_bits);
}

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
