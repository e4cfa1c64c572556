// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "host/trace/power.h"

// Twin of kernels/sampling.cl: where a pixel is sampled, and what each sample counts; the methods
// and their sources are named there.
namespace rt::trace {

/// v with the bits under mask and those `shift` above them exchanged.
inline std::uint32_t swap_bits(std::uint32_t v, std::uint32_t mask, std::uint32_t shift) {
    const std::uint32_t difference = ((v >> shift) ^ v) & mask;
    return v ^ difference ^ (difference << shift);
}

/// Bits in reverse order.
inline std::uint32_t reverse_bits(std::uint32_t v) {
    v = swap_bits(v, 0x55555555u, 1);
    v = swap_bits(v, 0x33333333u, 2);
    v = swap_bits(v, 0x0f0f0f0fu, 4);
    v = swap_bits(v, 0x00ff00ffu, 8);
    return swap_bits(v, 0x0000ffffu, 16);
}

/// A hash in which every bit of the input moves about half the bits of the output.
inline std::uint32_t hash_bits(std::uint32_t v) {
    v ^= v >> 17;
    v *= 0xed5ad4bbu;
    v ^= v >> 11;
    v *= 0xac4c1b51u;
    v ^= v >> 15;
    v *= 0x31848babu;
    return v ^ (v >> 14);
}

/// Owen's nested uniform scramble of the bits of v.
inline std::uint32_t owen_scramble(std::uint32_t v, std::uint32_t seed) {
    v = reverse_bits(v);
    v += seed;
    v ^= v * 0x6c50b47cu;
    v ^= v * 0xb82f1e52u;
    v ^= v * 0xc7afe638u;
    v ^= v * 0x8d22f6e6u;
    return reverse_bits(v);
}

/// The second dimension of Sobol's sequence; the first is reverse_bits.
inline std::uint32_t sobol_second(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t direction = 0x80000000u; index != 0;
         index >>= 1, direction ^= direction >> 1) {
        if (index & 1u) result ^= direction;
    }
    return result;
}

template <typename T>
struct Position {
    T x, y;
};

/// The 12 leading bits as a number in the middle of its 4096th of (0, 1).
template <typename T>
T unit_from_bits(std::uint32_t bits) {
    return (T(bits >> 20) + T(0.5)) * T(0x1p-12);
}

template <typename T>
Position<T> sobol_position(std::uint32_t seed, std::uint32_t k) {
    const std::uint32_t index = owen_scramble(k, hash_bits(seed));
    return {unit_from_bits<T>(owen_scramble(reverse_bits(index), hash_bits(seed ^ 0x9e3779b9u))),
            unit_from_bits<T>(owen_scramble(sobol_second(index), hash_bits(seed ^ 0x85ebca6bu)))};
}

template <typename T>
Position<T> grid_position(typename Flat<T>::Index grid, typename Flat<T>::Index k) {
    const T step = T(1) / T(grid);
    return {(T(k % grid) + T(0.5)) * step, (T(k / grid) + T(0.5)) * step};
}

/// Sample k of pixel (x, y) in the unit square.
template <typename T>
Position<T> unit_position(const typename Flat<T>::Frame& frame, typename Flat<T>::Index x,
                          typename Flat<T>::Index y, typename Flat<T>::Index k) {
    if (frame.grid != 0) return grid_position<T>(frame.grid, k);
    const auto pixel = static_cast<std::uint32_t>(y) * 65536u + static_cast<std::uint32_t>(x);
    const std::uint32_t seed = hash_bits(pixel ^ hash_bits(static_cast<std::uint32_t>(frame.seed)));
    return sobol_position<T>(seed, static_cast<std::uint32_t>(k));
}

/// Half the side of a filter's footprint, in pixels.
template <typename T>
T filter_radius(typename Flat<T>::Index filter) {
    if (filter == f32::RT_FILTER_TENT) return T(1);
    if (filter == f32::RT_FILTER_GAUSSIAN) return T(1.5);
    return filter == f32::RT_FILTER_MITCHELL ? T(2) : T(0.5);
}

/// Twice the cubic: only ratios of weights count.
template <typename T>
T mitchell_weight(T d) {
    const T third = T(1) / T(3);
    if (d < T(1)) {
        return std::fma(std::fma(T(7) * third, d, T(-4)), d * d, T(16) * third / T(3));
    }
    const T cubic = std::fma(T(-7) * third / T(3), d, T(4));
    return std::fma(std::fma(cubic, d, T(-20) * third), d, T(32) * third / T(3));
}

/// The filter's weight at distance d from the pixel's centre along one axis.
template <typename T>
T filter_weight(typename Flat<T>::Index filter, T d) {
    d = std::fabs(d);
    if (filter == f32::RT_FILTER_TENT) return T(1) - d;
    if (filter == f32::RT_FILTER_MITCHELL) return mitchell_weight(d);
    // e^(-2 d^2) - e^(-2 1.5^2)
    constexpr T rate = T(-2) * PowerConstants<T>::log2_e;
    return exp2_of_product(rate, d * d) - exp2_of_product(rate, T(2.25));
}

/// Sample k of pixel (x, y), in pixels from the pixel's lower left corner.
template <typename T>
Position<T> sample_position(const typename Flat<T>::Frame& frame, typename Flat<T>::Index x,
                            typename Flat<T>::Index y, typename Flat<T>::Index k) {
    Position<T> position = unit_position<T>(frame, x, y, k);
    if (frame.filter == f32::RT_FILTER_BOX) return position;
    const T side = T(2) * filter_radius<T>(frame.filter);
    position.x = std::fma(position.x - T(0.5), side, T(0.5));
    position.y = std::fma(position.y - T(0.5), side, T(0.5));
    return position;
}

/// What sample k of pixel (x, y) counts; 1 under the box filter.
template <typename T>
T sample_weight(const typename Flat<T>::Frame& frame, typename Flat<T>::Index x,
                typename Flat<T>::Index y, typename Flat<T>::Index k) {
    if (frame.filter == f32::RT_FILTER_BOX) return T(1);
    const Position<T> position = sample_position<T>(frame, x, y, k);
    return filter_weight<T>(frame.filter, position.x - T(0.5)) *
           filter_weight<T>(frame.filter, position.y - T(0.5));
}

}  // namespace rt::trace
