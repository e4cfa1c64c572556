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
    static constexpr float log2_e = 0x1.715476p+0f, exp2_lowest = -125.0f, rounder = 0x1.8p23f;
    static constexpr float least_squared = 0x1p-100f, low = 0x1p-60f, lift = 0x1p100f;
    static constexpr float lifted_binades = 200.0f * 0x1p23f;
    /// from the highest power down
    static constexpr std::array log2_tail = {0x1.c085d4p-3f, 0x1.272704p-2f, 0x1.ec7126p-2f};
    static constexpr std::array exp2_series = {0x1.414ee6p-13f,
                                               0x1.5f03dap-10f,
                                               0x1.3b2e0cp-7f,
                                               0x1.c6af88p-5f,
                                               0x1.ebfbdcp-3f,
                                               0x1.62e43p-1f,
                                               1.0f};
};

template <>
struct PowerConstants<double> {
    static constexpr double log2_e = 0x1.71547652b82fep+0, exp2_lowest = -1021.0,
                            rounder = 0x1.8p52;
    static constexpr double least_squared = 0x1p-900, low = 0x1p-500, lift = 0x1p600;
    static constexpr double lifted_binades = 1200.0 * 0x1p52;
    static constexpr std::array log2_tail = {
        0x1.98e135b0a975cp-4, 0x1.85407f17ab64ep-4, 0x1.c6c02dab2152dp-4, 0x1.0c99f2503671ap-3,
        0x1.484b15d4d6e55p-3, 0x1.a61762a3db6b9p-3, 0x1.2776c50efb864p-2, 0x1.ec709dc3a03f4p-2};
    static constexpr std::array exp2_series = {
        0x1.e7c699a3acd5dp-32, 0x1.e617b560d88fep-28, 0x1.b5265306b71ffp-24, 0x1.62bfc9f511cedp-20,
        0x1.ffcbfbc7b3697p-17, 0x1.4309130dc595cp-13, 0x1.5d87fe78c3786p-10, 0x1.3b2ab6fba0791p-7,
        0x1.c6b08d704a046p-5,  0x1.ebfbdff82c5a1p-3,  0x1.62e42fefa39efp-1,  1.0};
};

/// The polynomial with these coefficients, highest power first, at x.
template <typename T, std::size_t N>
T horner(const std::array<T, N>& coefficients, T x) {
    T sum = coefficients[0];
    for (std::size_t i = 1; i < N; ++i) sum = std::fma(sum, x, coefficients[i]);
    return sum;
}

/// log2((1 + z) / (1 - z)) / 2 for |z| <= 1/5
template <typename T>
T log2_series(T z) {
    using C = PowerConstants<T>;
    const T w = z * z;
    return std::fma(z * w, horner(C::log2_tail, w), z * C::log2_e);
}

/// log2 of the cosine between the unit vector n and s, from n.s > 0, |s - (n.s) n|^2 and s.s >=
/// least_squared; never above 0.
template <typename T>
T log2_cosine(T along, T across, T squared) {
    using C = PowerConstants<T>;
    using Index = typename Flat<T>::Index;
    constexpr Index binade = Bits<T>::binade;
    const bool low = along < C::low;
    const T lifted = low ? along * C::lift : along;
    const Index bits = std::bit_cast<Index>(lifted * lifted);
    const Index ratio = bits - std::bit_cast<Index>(squared);
    const Index binades = (ratio + binade / 2) & -binade;
    const T scaled = std::bit_cast<T>(bits - binades);
    const bool near = binades >= 0 && !low;
    const T difference = near ? -across : scaled - squared;
    const T sum = near ? std::fma(T(2), squared, -across) : scaled + squared;
    const T k = low ? T(binades) - C::lifted_binades : T(binades);
    return min_of(T(0), std::fma(k, T(0.5) / T(binade), log2_series(difference / sum)));
}

/// 2^(a b) for a b <= 0; 0 where the result would not be a normal number, and for NaN
template <typename T>
T exp2_of_product(T a, T b) {
    using C = PowerConstants<T>;
    using Index = typename Flat<T>::Index;
    const T shifted = std::fma(a, b, C::rounder);
    if (!(shifted >= C::rounder + C::exp2_lowest)) return T(0);
    const T series = horner(C::exp2_series, std::fma(a, b, C::rounder - shifted));
    const Index power = std::bit_cast<Index>(shifted) << Bits<T>::mantissa_bits;
    return std::bit_cast<T>(std::bit_cast<Index>(series) + power);
}

/// max(0, n.s / |s|)^exponent from n.s, |s - (n.s) n|^2 and s.s. 0^0 is 1.
template <typename T>
T blinn_lobe(T along, T across, T squared, T exponent) {
    if (exponent == T(0)) return T(1);
    if (!(along > T(0) && squared >= PowerConstants<T>::least_squared)) return T(0);
    return exp2_of_product(exponent, log2_cosine(along, across, squared));
}

}  // namespace rt::trace
