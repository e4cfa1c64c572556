// SPDX-License-Identifier: Apache-2.0
//
// Where a pixel is sampled, and what each sample counts.
//
// Grid: grid x grid regular positions. Sobol: the first two dimensions of Sobol's sequence,
// Owen-scrambled by hashing and shuffled, seeded by the pixel (Burley, Practical Hash-based Owen
// Scrambling, JCGT 9(4), 2020, with its constants). Offsets are multiples of 2^-13, so that float
// and double sample the same places in pictures up to 2048 pixels wide.
//
// A filter wider than the pixel spreads the samples over its square footprint and weighs them: a
// pixel is sum(weight x colour) / sum(weight) over samples of its own (Mitchell and Netravali 1988
// for the cubic, B = C = 1/3; the Gaussian is exp(-2 d^2), cut off at 1.5 pixels).
#ifndef RT_SAMPLING_CL
#define RT_SAMPLING_CL

#include "kernels/power.cl"
#include "kernels/scene_view.h"

// v with the bits under mask and those `shift` above them exchanged.
uint swap_bits(uint v, uint mask, uint shift) {
    uint difference = ((v >> shift) ^ v) & mask;
    return v ^ difference ^ (difference << shift);
}

// Bits in reverse order. By exclusive ors, since compilers make an intrinsic of the usual ands and
// ors, which Oclgrind does not know.
uint reverse_bits(uint v) {
    v = swap_bits(v, 0x55555555u, 1);
    v = swap_bits(v, 0x33333333u, 2);
    v = swap_bits(v, 0x0f0f0f0fu, 4);
    v = swap_bits(v, 0x00ff00ffu, 8);
    return swap_bits(v, 0x0000ffffu, 16);
}

// A hash in which every bit of the input moves about half the bits of the output (Wellons'
// triple32).
uint hash_bits(uint v) {
    v ^= v >> 17;
    v *= 0xed5ad4bbu;
    v ^= v >> 11;
    v *= 0xac4c1b51u;
    v ^= v >> 15;
    v *= 0x31848babu;
    return v ^ (v >> 14);
}

// Owen's nested uniform scramble of the bits of v.
uint owen_scramble(uint v, uint seed) {
    v = reverse_bits(v);
    v += seed;
    v ^= v * 0x6c50b47cu;
    v ^= v * 0xb82f1e52u;
    v ^= v * 0xc7afe638u;
    v ^= v * 0x8d22f6e6u;
    return reverse_bits(v);
}

// The second dimension of Sobol's sequence; the first is reverse_bits.
uint sobol_second(uint index) {
    uint result = 0;
    for (uint direction = 0x80000000u; index != 0; index >>= 1, direction ^= direction >> 1) {
        if (index & 1u) result ^= direction;
    }
    return result;
}

typedef struct {
    Real x, y;
} Position;

// The 12 leading bits as a number in the middle of its 4096th of (0, 1).
Real unit_from_bits(uint bits) { return ((Real)(bits >> 20) + (Real)0.5) * (Real)0x1p-12f; }

Position sobol_position(uint seed, uint k) {
    uint index = owen_scramble(k, hash_bits(seed));
    Position position;
    position.x = unit_from_bits(owen_scramble(reverse_bits(index), hash_bits(seed ^ 0x9e3779b9u)));
    position.y = unit_from_bits(owen_scramble(sobol_second(index), hash_bits(seed ^ 0x85ebca6bu)));
    return position;
}

Position grid_position(Index grid, Index k) {
    Position position;
    position.x = ((Real)(k % grid) + (Real)0.5) / (Real)grid;
    position.y = ((Real)(k / grid) + (Real)0.5) / (Real)grid;
    return position;
}

// Sample k of pixel (x, y) in the unit square.
Position unit_position(const Frame* frame, Index x, Index y, Index k) {
    if (frame->grid != 0) return grid_position(frame->grid, k);
    uint pixel = (uint)y * 65536u + (uint)x;
    return sobol_position(hash_bits(pixel ^ hash_bits((uint)frame->seed)), (uint)k);
}

// Half the side of a filter's footprint, in pixels.
Real filter_radius(Index filter) {
    if (filter == RT_FILTER_TENT) return (Real)1;
    if (filter == RT_FILTER_GAUSSIAN) return (Real)1.5f;
    return filter == RT_FILTER_MITCHELL ? (Real)2 : (Real)0.5f;
}

// Twice the cubic: only ratios of weights count.
Real mitchell_weight(Real d) {
    Real third = (Real)1 / (Real)3;
    if (d < (Real)1)
        return fma(fma((Real)7 * third, d, (Real)-4), d * d, (Real)16 * third / (Real)3);
    Real cubic = fma((Real)-7 * third / (Real)3, d, (Real)4);
    return fma(fma(cubic, d, (Real)-20 * third), d, (Real)32 * third / (Real)3);
}

// The filter's weight at distance d from the pixel's centre along one axis.
Real filter_weight(Index filter, Real d) {
    d = fabs(d);
    if (filter == RT_FILTER_TENT) return (Real)1 - d;
    if (filter == RT_FILTER_MITCHELL) return mitchell_weight(d);
    return exp_negative((Real)-2 * d * d) - exp_negative((Real)-4.5f);
}

// Sample k of pixel (x, y), in pixels from the pixel's lower left corner.
Position sample_position(const Frame* frame, Index x, Index y, Index k) {
    Position position = unit_position(frame, x, y, k);
    if (frame->filter == RT_FILTER_BOX) return position;
    Real side = (Real)2 * filter_radius(frame->filter);
    position.x = fma(position.x - (Real)0.5f, side, (Real)0.5f);
    position.y = fma(position.y - (Real)0.5f, side, (Real)0.5f);
    return position;
}

// What sample k of pixel (x, y) counts; 1 under the box filter.
Real sample_weight(const Frame* frame, Index x, Index y, Index k) {
    if (frame->filter == RT_FILTER_BOX) return (Real)1;
    Position position = sample_position(frame, x, y, k);
    return filter_weight(frame->filter, position.x - (Real)0.5f) *
           filter_weight(frame->filter, position.y - (Real)0.5f);
}

#endif
