// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "host/trace/bits.h"
#include "host/trace/math.h"

// Twin of kernels/power.cl: the Blinn lobe from + - * / and fma alone.
namespace rt::trace {

template <typename T>
struct PowerConstants;

template <>
struct PowerConstants<float> {
    static constexpr float exp_lowest = -87.0f, log2_e = 1.44269504f, sqrt2 = 1.41421356f;
    static constexpr float ln2_high = 0x1.62e4p-1f, ln2_low = 0x1.7f7d1cp-20f;
    /// 1/(2i+1) from the highest power down, and 1/i! likewise
    static constexpr std::array atanh_tail = {1.0f / 9, 1.0f / 7, 1.0f / 5, 1.0f / 3};
    static constexpr std::array exp_series = {1.0f / 5040, 1.0f / 720, 1.0f / 120, 1.0f / 24,
                                              1.0f / 6,    1.0f / 2,   1.0f,       1.0f};
};

template <>
struct PowerConstants<double> {
    static constexpr double exp_lowest = -708.0, log2_e = 1.4426950408889634,
                            sqrt2 = 1.4142135623730951;
    static constexpr double ln2_high = 0x1.62e42fefap-1, ln2_low = 0x1.cf79abc9e3b3ap-40;
    static constexpr std::array atanh_tail = {1.0 / 23, 1.0 / 21, 1.0 / 19, 1.0 / 17,
                                              1.0 / 15, 1.0 / 13, 1.0 / 11, 1.0 / 9,
                                              1.0 / 7,  1.0 / 5,  1.0 / 3};
    static constexpr std::array exp_series = {1.0 / 6227020800,
                                              1.0 / 479001600,
                                              1.0 / 39916800,
                                              1.0 / 3628800,
                                              1.0 / 362880,
                                              1.0 / 40320,
                                              1.0 / 5040,
                                              1.0 / 720,
                                              1.0 / 120,
                                              1.0 / 24,
                                              1.0 / 6,
                                              1.0 / 2,
                                              1.0,
                                              1.0};
};

/// The polynomial with these coefficients, highest power first, at x.
template <typename T, std::size_t N>
T horner(const std::array<T, N>& coefficients, T x) {
    T sum = coefficients[0];
    for (std::size_t i = 1; i < N; ++i) sum = std::fma(sum, x, coefficients[i]);
    return sum;
}

/// 2 atanh(z) for |z| <= 0.172
template <typename T>
T twice_atanh(T z) {
    const T w = z * z;
    const T twice = T(2) * z;
    return std::fma(twice * w, horner(PowerConstants<T>::atanh_tail, w), twice);
}

/// log(cosine) for 0 < cosine <= 1, subnormal ones included; from gap = 1 - cosine where the cosine
/// is above 13/16.
template <typename T>
T log_cosine(T cosine, T gap) {
    using C = PowerConstants<T>;
    using Index = typename Flat<T>::Index;
    T k = 0, above = -gap, below = T(2) - gap;
    if (!(cosine > T(0.8125))) {
        Index shift = 0;
        if (cosine < std::numeric_limits<T>::min()) {
            shift = Bits<T>::mantissa_bits + 1;
            cosine *= power_of_two<T>(shift);
        }
        Index exponent = exponent_of(cosine) - shift;
        T m = mantissa_of(cosine);
        if (m > C::sqrt2) {
            m *= T(0.5);
            exponent += 1;
        }
        k = T(exponent);
        above = m - T(1);
        below = m + T(1);
    }
    return std::fma(k, C::ln2_high, std::fma(k, C::ln2_low, twice_atanh(above / below)));
}

/// exp(y) for y <= 0; 0 where the result would not be a normal number
template <typename T>
T exp_negative(T y) {
    using C = PowerConstants<T>;
    if (!(y > C::exp_lowest)) return T(0);
    const auto k = static_cast<typename Flat<T>::Index>(y * C::log2_e - T(0.5));
    T r = std::fma(T(-k), C::ln2_high, y);
    r = std::fma(T(-k), C::ln2_low, r);
    return horner(C::exp_series, r) * power_of_two<T>(k);
}

/// max(0, n.h)^exponent for unit n and h; half_gap is |n - h|^2 / 2. 0^0 is 1.
template <typename T>
T blinn_lobe(T n_dot_h, T half_gap, T exponent) {
    if (exponent == T(0)) return T(1);
    if (!(n_dot_h > T(0))) return T(0);
    return exp_negative(exponent * log_cosine(n_dot_h, half_gap));
}

}  // namespace rt::trace
