// SPDX-License-Identifier: Apache-2.0
//
// Numbers taken apart: exponent, mantissa, neighbours. By bits, since frexp, ldexp and nextafter
// are slow on some runtimes and flush subnormals on others.
#ifndef RT_BITS_CL
#define RT_BITS_CL

#include "kernels/lanes.h"

#ifdef RT_DOUBLE
#define RT_MANTISSA_BITS 52
#define RT_EXPONENT_BIAS 1023
#define RT_MIN_NORMAL 0x1p-1022
#define RT_INDEX_ONE 1L
#else
#define RT_MANTISSA_BITS 23
#define RT_EXPONENT_BIAS 127
#define RT_MIN_NORMAL 0x1p-126f
#define RT_INDEX_ONE 1
#endif

#define RT_AS_INDICES RT_JOIN(as_, RT_LANES_OF(RT_INDEX))
#define RT_AS_REALS RT_JOIN(as_, RT_LANES_OF(RT_REAL))

// x = mantissa_of(x) * 2^exponent_of(x) for normal x > 0; the mantissa is in [1, 2).
Indices exponent_of(Reals x) { return (RT_AS_INDICES(x) >> RT_MANTISSA_BITS) - RT_EXPONENT_BIAS; }

Reals mantissa_of(Reals x) {
    Indices fraction = RT_AS_INDICES(x) & ((RT_INDEX_ONE << RT_MANTISSA_BITS) - 1);
    return RT_AS_REALS(fraction | ((Index)RT_EXPONENT_BIAS << RT_MANTISSA_BITS));
}

// 2^k for a normal result
Reals power_of_two(Indices k) { return RT_AS_REALS((k + RT_EXPONENT_BIAS) << RT_MANTISSA_BITS); }

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
