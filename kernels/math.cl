// SPDX-License-Identifier: Apache-2.0
//
// Vectors. Our own dot and normalize, since the built-in ones round differently from vendor to
// vendor (numerics: normalize is off by 2.8 ulp on one runtime and 0.5 on another). Explicit fma is
// correctly rounded everywhere, hence both exact in its definition and fast.
#ifndef RT_MATH_CL
#define RT_MATH_CL

#include "kernels/types.h"

real3 load3(Packed3 p) { return (real3)(p.x, p.y, p.z); }

Real dot3(real3 a, real3 b) { return fma(a.z, b.z, fma(a.y, b.y, a.x * b.x)); }

// a + s * b
real3 add_scaled(real3 a, Real s, real3 b) { return fma((real3)(s), b, a); }

Real length3(real3 v) { return sqrt(dot3(v, v)); }

real3 normalize3(real3 v) { return v * ((Real)1 / length3(v)); }

real3 abs3(real3 v) { return fabs(v); }

// a b - c d with an error below 1.5 ulp and hence the right sign (Kahan; Jeannerod, Louvet and
// Muller 2013), whatever cancels.
Real difference_of_products(Real a, Real b, Real c, Real d) {
    Real cd = c * d;
    return fma(a, b, -cd) + fma(-c, d, cd);
}

// The mirror direction of d (towards the surface) about the unit normal n.
real3 reflect3(real3 d, real3 n) { return add_scaled(d, (Real)-2 * dot3(d, n), n); }

#endif
