// SPDX-License-Identifier: Apache-2.0
//
// Numbers as bits: the next one, and the parts of logarithms and powers (power.cl). Not by frexp,
// ldexp and nextafter, which are slow on some runtimes and flush subnormals on others.
#ifndef RT_BITS_CL
#define RT_BITS_CL

#include "kernels/lanes.h"

#ifdef RT_DOUBLE
#define RT_MANTISSA_BITS 52
#else
#define RT_MANTISSA_BITS 23
#endif

// Added to the bits of a number, doubles it.
#define RT_BINADE ((Index)1 << RT_MANTISSA_BITS)

#define RT_AS_INDICES RT_JOIN(as_, RT_LANES_OF(RT_INDEX))
#define RT_AS_REALS RT_JOIN(as_, RT_LANES_OF(RT_REAL))

// The next number above x (direction > 0), below it (direction < 0), or x (direction == 0).
Reals one_ulp_towards(Reals x, Reals direction) {
    Mask up = direction > (Reals)0;
    Mask away_from_zero = (x > (Reals)0) == up;
    Indices bits = RT_AS_INDICES(x) + (away_from_zero ? (Indices)1 : (Indices)-1);
    Reals smallest = RT_AS_REALS((Indices)1);
    Reals from_zero = up ? smallest : -smallest;
    Reals moved = x == (Reals)0 ? from_zero : RT_AS_REALS(bits);
    return direction == (Reals)0 ? x : moved;
}

#endif
