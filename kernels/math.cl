// SPDX-License-Identifier: Apache-2.0
//
// Vectors. Our own dot and normalize, since the built-in ones round differently from vendor to
// vendor (numerics: normalize is off by 2.8 ulp on one runtime and 0.5 on another). Explicit fma is
// correctly rounded everywhere, so these are well defined and fast.
#ifndef RT_MATH_CL
#define RT_MATH_CL

#include "kernels/lanes.h"

Reals min_of(Reals a, Reals b) { return a < b ? a : b; }
Reals max_of(Reals a, Reals b) { return a > b ? a : b; }

real3 make3(Reals x, Reals y, Reals z) {
    real3 v = {x, y, z};
    return v;
}

// The same vector in every lane.
real3 load3(Packed3 p) { return make3((Reals)p.x, (Reals)p.y, (Reals)p.z); }

real3 select3(Mask mask, real3 yes, real3 no) {
    return make3(mask ? yes.x : no.x, mask ? yes.y : no.y, mask ? yes.z : no.z);
}

real3 add3(real3 a, real3 b) { return make3(a.x + b.x, a.y + b.y, a.z + b.z); }

real3 sub3(real3 a, real3 b) { return make3(a.x - b.x, a.y - b.y, a.z - b.z); }

// Component by component: light times reflectance.
real3 mul3(real3 a, real3 b) { return make3(a.x * b.x, a.y * b.y, a.z * b.z); }

real3 scale3(Reals s, real3 v) { return make3(s * v.x, s * v.y, s * v.z); }

real3 divide3(real3 v, Reals s) { return make3(v.x / s, v.y / s, v.z / s); }

real3 negate3(real3 v) { return make3(-v.x, -v.y, -v.z); }

real3 abs3(real3 v) { return make3(fabs(v.x), fabs(v.y), fabs(v.z)); }

Reals dot3(real3 a, real3 b) { return fma(a.z, b.z, fma(a.y, b.y, a.x * b.x)); }

// a + s * b
real3 add_scaled(real3 a, Reals s, real3 b) {
    return make3(fma(s, b.x, a.x), fma(s, b.y, a.y), fma(s, b.z, a.z));
}

// Light times a weight: 0 where the weight is 0, however bright the light.
Reals weighed(Reals weight, Reals light) { return weight != (Reals)0 ? weight * light : (Reals)0; }
real3 weigh3(real3 weight, real3 light) {
    return make3(weighed(weight.x, light.x), weighed(weight.y, light.y),
                 weighed(weight.z, light.z));
}

// Clamps infinite components to the largest number, so that times 0 they give 0.
Reals limited(Reals x) { return x < (Reals)RT_LARGEST ? x : (Reals)RT_LARGEST; }
real3 limit3(real3 v) { return make3(limited(v.x), limited(v.y), limited(v.z)); }

// The rounding error a + s b - sum, almost exactly (Knuth's TwoSum, and the product by fma).
Reals lost(Reals a, Reals s, Reals b, Reals sum) {
    Reals product = s * b;
    Reals product_low = fma(s, b, -product);
    Reals total = a + product;
    Reals taken = total - a;
    Reals total_low = (a - (total - taken)) + (product - taken);
    return (total - sum) + (total_low + product_low);
}

// The part of add_scaled(a, s, b) lost by rounding to `sum`.
real3 fma_error3(real3 a, Reals s, real3 b, real3 sum) {
    return make3(lost(a.x, s, b.x, sum.x), lost(a.y, s, b.y, sum.y), lost(a.z, s, b.z, sum.z));
}

Reals length3(real3 v) { return sqrt(dot3(v, v)); }

real3 normalize3(real3 v) { return scale3((Reals)1 / length3(v), v); }

// a b - c d with an error below 1.5 ulp and hence the right sign (Kahan; Jeannerod, Louvet and
// Muller 2013), even under cancellation.
Reals difference_of_products(Reals a, Reals b, Reals c, Reals d) {
    Reals cd = c * d;
    return fma(a, b, -cd) + fma(-c, d, cd);
}

// The mirror direction of d (towards the surface) about the unit normal n.
real3 reflect3(real3 d, real3 n) { return add_scaled(d, (Reals)-2 * dot3(d, n), n); }

#endif
