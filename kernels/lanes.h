// SPDX-License-Identifier: Apache-2.0
//
// Reductions over a packet's lanes, and access to single lanes.
#ifndef RT_LANES_H
#define RT_LANES_H

#include "kernels/builtins.h"

#ifdef RT_DOUBLE
#define RT_MAX_INDEX LONG_MAX
#else
#define RT_MAX_INDEX INT_MAX
#endif

#ifdef __has_builtin
#if __has_builtin(__builtin_reduce_or) && __has_builtin(__builtin_reduce_min)
#define RT_HAS_REDUCTIONS
#endif
#endif

#if RT_LANES == 1

#define RT_LANE_NUMBERS ((Indices)0)

bool any_lane(Mask mask) { return mask != 0; }
Index least_lane(Mask mask, Indices v) { return mask != 0 ? v : RT_MAX_INDEX; }
Index sum_lanes(Indices v) { return v; }

#else

#if RT_LANES == 2
#define RT_LANE_NUMBERS ((Indices)(0, 1))
#elif RT_LANES == 4
#define RT_LANE_NUMBERS ((Indices)(0, 1, 2, 3))
#elif RT_LANES == 8
#define RT_LANE_NUMBERS ((Indices)(0, 1, 2, 3, 4, 5, 6, 7))
#else
#define RT_LANE_NUMBERS ((Indices)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#endif

// Reduces a packet by halves.
#define RT_FOLD2(v, op) op((v).lo, (v).hi)
#if RT_LANES == 2
#define RT_FOLD(v, op) RT_FOLD2(v, op)
#elif RT_LANES == 4
#define RT_FOLD(v, op) RT_FOLD2(RT_FOLD2(v, op), op)
#elif RT_LANES == 8
#define RT_FOLD(v, op) RT_FOLD2(RT_FOLD2(RT_FOLD2(v, op), op), op)
#else
#define RT_FOLD(v, op) RT_FOLD2(RT_FOLD2(RT_FOLD2(RT_FOLD2(v, op), op), op), op)
#endif
#define RT_PLUS(a, b) ((a) + (b))

bool any_lane(Mask mask) {
#ifdef RT_HAS_REDUCTIONS
    return __builtin_reduce_or(mask != (Mask)0) != 0;
#else
    return any(mask);
#endif
}

// The smallest v in the mask's lanes, at least one of which must be set.
Index least_lane(Mask mask, Indices v) {
    Indices candidates = mask ? v : (Indices)RT_MAX_INDEX;
#ifdef RT_HAS_REDUCTIONS
    return __builtin_reduce_min(candidates);
#else
    return RT_FOLD(candidates, min);
#endif
}

Index sum_lanes(Indices v) { return RT_FOLD(v, RT_PLUS); }

#endif

// A packet's lanes one by one.
typedef union {
    Reals all;
    Real lane[RT_LANES];
} RealLanes;

typedef union {
    Indices all;
    Index lane[RT_LANES];
} IndexLanes;

#endif
