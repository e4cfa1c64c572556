// SPDX-License-Identifier: Apache-2.0
//
// Floating-point bits: the next number, and parts of logarithms and powers (power.cl). Not by
// frexp, ldexp and nextafter, which are slow on some runtimes and flush subnormals on others.
#ifndef RT_BITS_CL
#define RT_BITS_CL

#include "kernels/lanes.h"

#ifdef RT_DOUBLE
#define RT_MANTISSA_BITS 52
#else
#define RT_MANTISSA_BITS 23
#endif

// Adding this to a number's bits doubles it.
#define RT_BINADE ((Index)1 << RT_MANTISSA_BITS)

#define RT_AS_INDICES RT_JOIN(as_, RT_LANES_OF(RT_INDEX))
#define RT_AS_REALS RT_JOIN(as_, RT_LANES_OF(RT_REAL))

// The next number above x (direction > 0), below it (direction < 0), or x (direction == 0).
Reals one_ulp_towards(Reals x, Reals direction) {
    const Index sign_bit = 8 * (Index)sizeof(Index) - 1;
    Indices bits = RT_AS_INDICES(x);
    Indices side = RT_AS_INDICES(direction);
    Indices step = ((bits ^ side) >> sign_bit) | 1;  // 1 away from zero, -1 towards it
    Indices smallest = (side & RT_AS_INDICES((Reals)(Real)-0.0f)) | 1;
    Indices moved = x == (Reals)0 ? smallest : bits + step;
    return direction == (Reals)0 ? x : RT_AS_REALS(moved);
}

#endif
