// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#ifdef __AVX512F__
#include <immintrin.h>
#endif

/// A packet's numbers, one a lane, as vectors of the compiler: as many as the processor's have.
namespace embree_bench {

#ifdef __AVX512F__
constexpr int lanes = 16;
#else
constexpr int lanes = 8;
#endif
using Reals = float __attribute__((vector_size(4 * lanes)));
using Ints = std::int32_t __attribute__((vector_size(4 * lanes)));  ///< as a mask: -1 or 0 a lane

inline Reals reals(float v) { return Reals{} + v; }
inline Ints ints(std::int32_t v) { return Ints{} + v; }

inline unsigned lane_bits(Ints mask) {
#ifdef __AVX512F__
    const auto m = reinterpret_cast<__m512i>(mask);
    return _mm512_test_epi32_mask(m, m);
#else
    unsigned bits = 0;
    for (int i = 0; i < lanes; ++i) bits |= (mask[i] != 0 ? 1u : 0u) << i;
    return bits;
#endif
}

inline bool any(Ints mask) { return lane_bits(mask) != 0; }
inline int count(Ints mask) { return __builtin_popcount(lane_bits(mask)); }

inline Reals root(Reals v) {
#ifdef __AVX512F__
    return reinterpret_cast<Reals>(_mm512_sqrt_ps(reinterpret_cast<__m512>(v)));
#else
    Reals result;
    for (int i = 0; i < lanes; ++i) result[i] = std::sqrt(v[i]);
    return result;
#endif
}

inline Reals to_reals(Ints v) { return __builtin_convertvector(v, Reals); }
inline Ints bits_of(Reals v) { return reinterpret_cast<Ints>(v); }
inline Reals from_bits(Ints v) { return reinterpret_cast<Reals>(v); }
inline Reals magnitude(Reals v) { return from_bits(bits_of(v) & 0x7fffffff); }
inline Reals larger(Reals a, Reals b) { return a > b ? a : b; }

template <typename Lanes, typename Number>
Lanes loaded(const Number* p) {
    Lanes v;
    std::memcpy(&v, p, sizeof(v));
    return v;
}

template <typename Lanes, typename Number>
void stored(Lanes v, Number* p) {
    std::memcpy(p, &v, sizeof(v));
}

inline Ints gathered(const std::int32_t* table, Ints index) {
#ifdef __AVX512F__
    return reinterpret_cast<Ints>(
        _mm512_i32gather_epi32(reinterpret_cast<__m512i>(index), table, 4));
#else
    Ints result;
    for (int i = 0; i < lanes; ++i) result[i] = table[index[i]];
    return result;
#endif
}

struct Vec3 {
    Reals x, y, z;
};

template <typename Packed3>
Vec3 all(const Packed3& p) {
    return {reals(p.x), reals(p.y), reals(p.z)};
}

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Vec3 operator*(Reals s, const Vec3& v) { return {s * v.x, s * v.y, s * v.z}; }
inline Vec3 operator-(const Vec3& v) { return {-v.x, -v.y, -v.z}; }
inline Reals dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 select(Ints mask, const Vec3& a, const Vec3& b) {
    return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}
inline Vec3 normalized(const Vec3& v) { return (1.0f / root(dot(v, v))) * v; }
inline Ints is_black(const Vec3& v) { return (v.x == 0.0f) & (v.y == 0.0f) & (v.z == 0.0f); }

// The Blinn lobe as in kernels/power.cl.

inline Reals log2_cosine(Reals along, Reals across, Reals squared) {
    const Ints low = along < 0x1p-60f;
    const Reals lifted = low ? along * 0x1p100f : along;
    const Ints bits = bits_of(lifted * lifted);
    const Ints binades = (bits - bits_of(squared) + (1 << 22)) & -(1 << 23);
    const Reals scaled = from_bits(bits - binades);
    const Ints near = (binades >= 0) & ~low;
    const Reals z = (near ? -across : scaled - squared) / (scaled + squared);
    Reals k = to_reals(binades);
    k = low ? k - 200.0f * 0x1p23f : k;
    k = k < 0.0f ? k : reals(0);
    const Reals w = z * z;
    Reals p = w * 0x1.c085d4p-3f + 0x1.272704p-2f;
    p = p * w + 0x1.ec7126p-2f;
    return k * 0x1p-24f + (z * w * p + z * 0x1.715476p+0f);
}

/// 2^(a b) for a b <= 0
inline Reals exp2_of_product(Reals a, Reals b) {
    const Reals shifted = a * b + 0x1.8p23f;
    const Reals r = a * b + (0x1.8p23f - shifted);
    Reals p = r * 0x1.414ee6p-13f + 0x1.5f03dap-10f;
    p = p * r + 0x1.3b2e0cp-7f;
    p = p * r + 0x1.c6af88p-5f;
    p = p * r + 0x1.ebfbdcp-3f;
    p = p * r + 0x1.62e43p-1f;
    p = p * r + 1.0f;
    return shifted >= 0x1.8p23f - 125.0f ? from_bits(bits_of(p) + (bits_of(shifted) << 23))
                                         : reals(0);
}

/// max(0, n.s / |s|)^exponent from n.s, |s - (n.s) n|^2 and s.s.
inline Reals blinn_lobe(Reals along, Reals across, Reals squared, Reals exponent) {
    const Reals lobe = exp2_of_product(exponent, log2_cosine(along, across, squared));
    const Ints lit = (along > 0.0f) & (squared >= 0x1p-100f);
    return exponent == 0.0f ? reals(1) : (lit ? lobe : reals(0));
}

}  // namespace embree_bench
