// SPDX-License-Identifier: Apache-2.0
//
// Numbers taken apart: exponent, mantissa, neighbours. By bits, since frexp, ldexp and nextafter
// are slow on some runtimes and flush subnormals on others.
#ifndef RT_BITS_CL
#define RT_BITS_CL

#include "kernels/types.h"

#ifdef RT_DOUBLE
#define RT_AS_INDEX as_long
#define RT_AS_REAL as_double
#define RT_MANTISSA_BITS 52
#define RT_EXPONENT_BIAS 1023
#define RT_MIN_NORMAL 0x1p-1022
#define RT_INDEX_ONE 1L
#else
#define RT_AS_INDEX as_int
#define RT_AS_REAL as_float
#define RT_MANTISSA_BITS 23
#define RT_EXPONENT_BIAS 127
#define RT_MIN_NORMAL 0x1p-126f
#define RT_INDEX_ONE 1
#endif

// x = mantissa_of(x) * 2^exponent_of(x) for normal x > 0; the mantissa is in [1, 2).
Index exponent_of(Real x) { return (RT_AS_INDEX(x) >> RT_MANTISSA_BITS) - RT_EXPONENT_BIAS; }

Real mantissa_of(Real x) {
    Index fraction = RT_AS_INDEX(x) & ((RT_INDEX_ONE << RT_MANTISSA_BITS) - 1);
    return RT_AS_REAL(fraction | ((Index)RT_EXPONENT_BIAS << RT_MANTISSA_BITS));
}

// 2^k for a normal result
Real power_of_two(Index k) { return RT_AS_REAL((k + RT_EXPONENT_BIAS) << RT_MANTISSA_BITS); }

// The next number above x (direction > 0), below it (direction < 0), or x (direction == 0).
Real one_ulp_towards(Real x, Real direction) {
    if (direction == (Real)0) return x;
    if (x == (Real)0)
        return direction > (Real)0 ? RT_AS_REAL(RT_INDEX_ONE) : -RT_AS_REAL(RT_INDEX_ONE);
    bool away_from_zero = (x > (Real)0) == (direction > (Real)0);
    return RT_AS_REAL(RT_AS_INDEX(x) + (away_from_zero ? 1 : -1));
}

#endif
