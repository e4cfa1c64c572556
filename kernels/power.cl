// SPDX-License-Identifier: Apache-2.0
//
// The Blinn lobe max(0, n.h)^e by + - * / and fma alone: pow differs between vendors and costs
// more. The half vector is never normalized: with s = l + v, n.h is n.s / |s|, and
//   log(n.h) = atanh(z), z = ((n.s)^2 - s.s) / ((n.s)^2 + s.s): one division and no square root.
// Near the peak the numerator is -|s - (n.s) n|^2: nothing cancels, and the rounding error of n.s
// is perpendicular to that difference. Farther off (n.s)^2 is first scaled by a power of 2 to about
// s.s. All in base 2, where the integer part of a logarithm is exact. Error below 9e-8 for every
// exponent up to 1e6, where pow(dot(n, h), e) is off by 0.45. Series: minimax polynomials.
#ifndef RT_POWER_CL
#define RT_POWER_CL

#include "kernels/bits.cl"
#include "kernels/math.cl"

#ifdef RT_DOUBLE
#define RT_LOG2_E 0x1.71547652b82fep+0
#define RT_EXP2_LOWEST -1021.0
#define RT_ROUNDER 0x1.8p52        // the low bits of x + this are x, rounded to an integer
#define RT_LEAST_SQUARED 0x1p-900  // |l + v|^2 is below it only if l and v are opposite
#define RT_LOW 0x1p-500            // if n.s is below it, its square may be subnormal
#define RT_LIFT 0x1p600
#define RT_LIFTED_BINADES (1200.0 * 0x1p52)

// (log2((1 + z) / (1 - z)) / (2 z) - log2(e)) / z^2 for z^2 = w <= 0.04
Reals log2_tail(Reals w) {
    Reals p = 0x1.98e135b0a975cp-4;
    p = fma(p, w, (Reals)0x1.85407f17ab64ep-4);
    p = fma(p, w, (Reals)0x1.c6c02dab2152dp-4);
    p = fma(p, w, (Reals)0x1.0c99f2503671ap-3);
    p = fma(p, w, (Reals)0x1.484b15d4d6e55p-3);
    p = fma(p, w, (Reals)0x1.a61762a3db6b9p-3);
    p = fma(p, w, (Reals)0x1.2776c50efb864p-2);
    return fma(p, w, (Reals)0x1.ec709dc3a03f4p-2);
}

// 2^r for |r| <= 1/2
Reals exp2_series(Reals r) {
    Reals p = 0x1.e7c699a3acd5dp-32;
    p = fma(p, r, (Reals)0x1.e617b560d88fep-28);
    p = fma(p, r, (Reals)0x1.b5265306b71ffp-24);
    p = fma(p, r, (Reals)0x1.62bfc9f511cedp-20);
    p = fma(p, r, (Reals)0x1.ffcbfbc7b3697p-17);
    p = fma(p, r, (Reals)0x1.4309130dc595cp-13);
    p = fma(p, r, (Reals)0x1.5d87fe78c3786p-10);
    p = fma(p, r, (Reals)0x1.3b2ab6fba0791p-7);
    p = fma(p, r, (Reals)0x1.c6b08d704a046p-5);
    p = fma(p, r, (Reals)0x1.ebfbdff82c5a1p-3);
    p = fma(p, r, (Reals)0x1.62e42fefa39efp-1);
    return fma(p, r, (Reals)1);
}
#else
#define RT_LOG2_E 0x1.715476p+0f
#define RT_EXP2_LOWEST -125.0f
#define RT_ROUNDER 0x1.8p23f
#define RT_LEAST_SQUARED 0x1p-100f
#define RT_LOW 0x1p-60f
#define RT_LIFT 0x1p100f
#define RT_LIFTED_BINADES (200.0f * 0x1p23f)

Reals log2_tail(Reals w) {
    Reals p = 0x1.c085d4p-3f;
    p = fma(p, w, (Reals)0x1.272704p-2f);
    return fma(p, w, (Reals)0x1.ec7126p-2f);
}

Reals exp2_series(Reals r) {
    Reals p = 0x1.414ee6p-13f;
    p = fma(p, r, (Reals)0x1.5f03dap-10f);
    p = fma(p, r, (Reals)0x1.3b2e0cp-7f);
    p = fma(p, r, (Reals)0x1.c6af88p-5f);
    p = fma(p, r, (Reals)0x1.ebfbdcp-3f);
    p = fma(p, r, (Reals)0x1.62e43p-1f);
    return fma(p, r, (Reals)1);
}
#endif

// log2((1 + z) / (1 - z)) / 2 for |z| <= 0.2
Reals log2_series(Reals z) {
    Reals w = z * z;
    return fma(z * w, log2_tail(w), z * (Reals)RT_LOG2_E);
}

// log2 of the cosine between the unit vector n and s, from n.s > 0, |s - (n.s) n|^2 and
// s.s >= RT_LEAST_SQUARED. Never above 0. Correct for subnormal cosines, too.
Reals log2_cosine(Reals along, Reals across, Reals squared) {
    Mask low = along < (Reals)RT_LOW;
    Reals lifted = low ? along * (Reals)RT_LIFT : along;
    Indices bits = RT_AS_INDICES(lifted * lifted);
    // A number's bits are its base-2 logarithm to within 0.09. Rounding the difference of two to
    // whole binades leaves a ratio between 2/3 and 3/2.
    Indices ratio = bits - RT_AS_INDICES(squared);
    Indices binades = (ratio + RT_BINADE / 2) & -RT_BINADE;
    Reals scaled = RT_AS_REALS(bits - binades);
    Mask near = (binades >= (Indices)0) & !low;
    Reals difference = near ? -across : scaled - squared;
    Reals sum = near ? fma((Reals)2, squared, -across) : scaled + squared;
    Reals k = RT_TO_REALS(binades);
    k = low ? k - (Reals)RT_LIFTED_BINADES : k;
    const Real half_binade = (Real)0.5f / (Real)RT_BINADE;
    return min_of((Reals)0, fma(k, (Reals)half_binade, log2_series(difference / sum)));
}

// 2^(a b) for a b <= 0; 0 where the result would not be a normal number, and for NaN
Reals exp2_of_product(Reals a, Reals b) {
    Reals shifted = fma(a, b, (Reals)RT_ROUNDER);
    Reals r = fma(a, b, (Reals)RT_ROUNDER - shifted);
    Indices power = RT_AS_INDICES(shifted) << RT_MANTISSA_BITS;
    Reals result = RT_AS_REALS(RT_AS_INDICES(exp2_series(r)) + power);
    return shifted >= (Reals)(RT_ROUNDER + RT_EXP2_LOWEST) ? result : (Reals)0;
}

// max(0, n.s / |s|)^exponent from n.s, |s - (n.s) n|^2 and s.s. 0^0 is 1.
Reals blinn_lobe(Reals along, Reals across, Reals squared, Reals exponent) {
    Mask lit = (along > (Reals)0) & (squared >= (Reals)RT_LEAST_SQUARED);
    Reals lobe = exp2_of_product(exponent, log2_cosine(along, across, squared));
    lobe = lit ? lobe : (Reals)0;
    return exponent == (Reals)0 ? (Reals)1 : lobe;
}

#endif
