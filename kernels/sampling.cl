// SPDX-License-Identifier: Apache-2.0
//
// Sample positions in a pixel, and sample weights.
//
// Grid: grid x grid regular positions. Sobol: the first two dimensions of Sobol's sequence,
// Owen-scrambled by hashing and shuffled, seeded per pixel (Burley, Practical Hash-based Owen
// Scrambling, JCGT 9(4), 2020, with its constants). Offsets are multiples of 2^-13, so that float
// and double sample the same positions in pictures up to 2048 pixels wide.
//
// A filter wider than the pixel spreads the samples over its square footprint and weights them: a
// pixel is sum(weight x color) / sum(weight) over its own samples (Mitchell and Netravali 1988 for
// the cubic, B = C = 1/3; the Gaussian is exp(-2 d^2), cut off at 1.5 pixels).
#ifndef RT_SAMPLING_CL
#define RT_SAMPLING_CL

#include "kernels/power.cl"
#include "kernels/scene_view.h"

// v with the bits under mask swapped with those `shift` above them.
Uints swap_bits(Uints v, Uints mask, Uints shift) {
    Uints difference = ((v >> shift) ^ v) & mask;
    return v ^ difference ^ (difference << shift);
}

// Bits in reverse order. Uses XOR: compilers turn the usual ands and ors into an intrinsic that
// Oclgrind does not know.
Uints reverse_bits(Uints v) {
    v = swap_bits(v, (Uints)0x55555555u, (Uints)1);
    v = swap_bits(v, (Uints)0x33333333u, (Uints)2);
    v = swap_bits(v, (Uints)0x0f0f0f0fu, (Uints)4);
    v = swap_bits(v, (Uints)0x00ff00ffu, (Uints)8);
    return swap_bits(v, (Uints)0x0000ffffu, (Uints)16);
}

// A hash in which every input bit flips about half the output bits (Wellons' triple32).
Uints hash_bits(Uints v) {
    v ^= v >> 17;
    v *= 0xed5ad4bbu;
    v ^= v >> 11;
    v *= 0xac4c1b51u;
    v ^= v >> 15;
    v *= 0x31848babu;
    return v ^ (v >> 14);
}

// Owen's nested uniform scramble of the bits of v.
Uints owen_scramble(Uints v, Uints seed) {
    v = reverse_bits(v);
    v += seed;
    v ^= v * 0x6c50b47cu;
    v ^= v * 0xb82f1e52u;
    v ^= v * 0xc7afe638u;
    v ^= v * 0x8d22f6e6u;
    return reverse_bits(v);
}

// The second dimension of Sobol's sequence; the first is reverse_bits.
Uints sobol_second(Uints index) {
    Uints result = 0;
    uint direction = 0x80000000u;
    for (int bit = 0; bit < 32; ++bit, direction ^= direction >> 1) {
        result ^= direction * ((index >> (uint)bit) & 1u);
    }
    return result;
}

typedef struct {
    Reals x, y;
} Position;

// The leading 12 bits as a number in (0, 1): the middle of its 4096th.
Reals unit_from_bits(Uints bits) {
    return (RT_TO_REALS(bits >> 20) + (Reals)0.5f) * (Reals)0x1p-12f;
}

Position sobol_position(Uints seed, Uints k) {
    Uints index = owen_scramble(k, hash_bits(seed));
    Position position;
    position.x = unit_from_bits(owen_scramble(reverse_bits(index), hash_bits(seed ^ 0x9e3779b9u)));
    position.y = unit_from_bits(owen_scramble(sobol_second(index), hash_bits(seed ^ 0x85ebca6bu)));
    return position;
}

// Uses the reciprocal: one scalar division. It is accurate enough for the row to be right
// (tests/kernel_sampling_test.cpp); integer division would be slow.
Position grid_position(Index grid, Indices k) {
    Reals step = (Reals)((Real)1 / (Real)grid);
    Indices row = RT_TO_INDICES((RT_TO_REALS(k) + (Reals)0.5f) * step);
    Position position;
    position.x = (RT_TO_REALS(k - row * grid) + (Reals)0.5f) * step;
    position.y = (RT_TO_REALS(row) + (Reals)0.5f) * step;
    return position;
}

// Sample k of pixel (x, y) in the unit square.
Position unit_position(const LaunchParams* params, Indices x, Indices y, Indices k) {
    if (RT_HAS(EDGES) && params->tolerance > (Real)0) {  // kernels/edges.cl
        Position corner = {(Reals)0, (Reals)0};
        return corner;
    }
    if (!RT_HAS(SOBOL) || params->sampling == RT_SAMPLES_GRID) {
        return grid_position(params->grid, k);
    }
    Uints pixel = RT_TO_UINTS(y) * 65536u + RT_TO_UINTS(x);
    Uints seed = hash_bits((Uints)(uint)params->seed);
    return sobol_position(hash_bits(pixel ^ seed), RT_TO_UINTS(k));
}

// Half the width of a filter's footprint, in pixels.
Real filter_radius(Index filter) {
    if (filter == RT_FILTER_TENT) return (Real)1;
    if (filter == RT_FILTER_GAUSSIAN) return (Real)1.5f;
    return filter == RT_FILTER_MITCHELL ? (Real)2 : (Real)0.5f;
}

// Twice the cubic: only ratios of weights matter.
Reals mitchell_weight(Reals d) {
    Real third = (Real)1 / (Real)3;
    Reals inner = fma((Reals)((Real)7 * third), d, (Reals)-4);
    inner = fma(inner, d * d, (Reals)((Real)16 * third / (Real)3));
    Reals outer = fma((Reals)((Real)-7 * third / (Real)3), d, (Reals)4);
    outer = fma(outer, d, (Reals)((Real)-20 * third));
    outer = fma(outer, d, (Reals)((Real)32 * third / (Real)3));
    return d < (Reals)1 ? inner : outer;
}

// The filter's weight at distance d from the pixel's center along one axis.
Reals filter_weight(Index filter, Reals d) {
    d = fabs(d);
    if (filter == RT_FILTER_TENT) return (Reals)1 - d;
    if (filter == RT_FILTER_MITCHELL) return mitchell_weight(d);
    // e^(-2 d^2) - e^(-2 1.5^2)
    Reals rate = (Reals)((Real)-2 * RT_LOG2_E);
    return exp2_of_product(rate, d * d) - exp2_of_product(rate, (Reals)2.25f);
}

// Sample k of pixel (x, y), in pixels from the pixel's lower left corner.
Position sample_position(const LaunchParams* params, Indices x, Indices y, Indices k) {
    Position position = unit_position(params, x, y, k);
    if (!RT_HAS(FILTERS) || params->filter == RT_FILTER_BOX) return position;
    Reals side = (Reals)((Real)2 * filter_radius(params->filter));
    position.x = fma(position.x - (Reals)0.5f, side, (Reals)0.5f);
    position.y = fma(position.y - (Reals)0.5f, side, (Reals)0.5f);
    return position;
}

// The weight of sample k of pixel (x, y); 1 under the box filter.
Reals sample_weight(const LaunchParams* params, Indices x, Indices y, Indices k) {
    if (!RT_HAS(FILTERS) || params->filter == RT_FILTER_BOX) return (Reals)1;
    Position position = sample_position(params, x, y, k);
    return filter_weight(params->filter, position.x - (Reals)0.5f) *
           filter_weight(params->filter, position.y - (Reals)0.5f);
}

#endif
