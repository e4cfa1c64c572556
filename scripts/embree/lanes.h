// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#ifdef __AVX512F__
#include <immintrin.h>
#endif

/// Sixteen rays' numbers, one a lane, as vectors of the compiler.
namespace embree_bench {

constexpr int lanes = 16;
using Reals = float __attribute__((vector_size(64)));
using Ints = std::int32_t __attribute__((vector_size(64)));  ///< as a mask: -1 or 0 a lane

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
inline Ints to_ints(Reals v) { return __builtin_convertvector(v, Ints); }
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

// The Blinn lobe by the same series as kernels/power.cl.

inline Reals log_cosine(Reals cosine, Reals gap) {
    const Ints bits = bits_of(cosine);
    Ints exponent = (bits >> 23) - 127;
    Reals m = from_bits((bits & 0x7fffff) | (127 << 23));
    const Ints large = m > 1.41421356f;
    m = large ? m * 0.5f : m;
    exponent -= large;
    const Ints near = cosine > 0.8125f;
    const Reals k = near ? reals(0) : to_reals(exponent);
    const Reals z = (near ? -gap : m - 1.0f) / (near ? 2.0f - gap : m + 1.0f);
    const Reals w = z * z;
    Reals p = w * (1.0f / 9.0f) + (1.0f / 7.0f);
    p = p * w + (1.0f / 5.0f);
    p = p * w + (1.0f / 3.0f);
    const Reals twice = 2.0f * z;
    return k * 0.693147181f + ((twice * w) * p + twice);
}

inline Reals exp_negative(Reals y) {
    const Ints normal = y > -87.0f;
    y = normal ? y : reals(0);
    const Ints k = to_ints(y * 1.44269504f - 0.5f);
    const Reals r = to_reals(-k) * 0.693147181f + y;
    Reals p = r * (1.0f / 5040.0f) + (1.0f / 720.0f);
    p = p * r + (1.0f / 120.0f);
    p = p * r + (1.0f / 24.0f);
    p = p * r + (1.0f / 6.0f);
    p = p * r + 0.5f;
    p = (p * r + 1.0f) * r + 1.0f;
    return normal ? p * from_bits((k + 127) << 23) : reals(0);
}

/// max(0, n.h)^exponent; half_gap is |n - h|^2 / 2.
inline Reals blinn_lobe(Reals n_dot_h, Reals half_gap, Reals exponent) {
    const Reals lobe = exp_negative(exponent * log_cosine(n_dot_h, half_gap));
    return exponent == 0.0f ? reals(1) : (n_dot_h > 0.0f ? lobe : reals(0));
}

}  // namespace embree_bench
