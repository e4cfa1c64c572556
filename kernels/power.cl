// SPDX-License-Identifier: Apache-2.0
//
// The Blinn lobe max(0, n.h)^e from + - * / and fma alone: pow differs between vendors and costs
// more. Near the peak, where n.h rounds to 1, the lobe is taken from the difference vector:
// 1 - n.h = |n - h|^2 / 2, so log(n.h) = log1p(-|n - h|^2 / 2). Error below 3e-7 for every exponent
// up to 1e6, where pow(dot(n, h), e) is off by 0.45. Series: log(m) = 2 atanh((m - 1) / (m + 1)).
#ifndef RT_POWER_CL
#define RT_POWER_CL

#include "kernels/bits.cl"

#ifdef RT_DOUBLE
#define RT_EXP_LOWEST -708.0
#define RT_LOG2_E 1.4426950408889634
#define RT_LN2_HIGH 0x1.62e42fefap-1
#define RT_LN2_LOW 0x1.cf79abc9e3b3ap-40
#define RT_SQRT2 1.4142135623730951

// (atanh(z) / z - 1) / z^2 for z^2 = w <= 0.03
Reals atanh_tail(Reals w) {
    Reals p = 1.0 / 23.0;
    p = fma(p, w, (Reals)(1.0 / 21.0));
    p = fma(p, w, (Reals)(1.0 / 19.0));
    p = fma(p, w, (Reals)(1.0 / 17.0));
    p = fma(p, w, (Reals)(1.0 / 15.0));
    p = fma(p, w, (Reals)(1.0 / 13.0));
    p = fma(p, w, (Reals)(1.0 / 11.0));
    p = fma(p, w, (Reals)(1.0 / 9.0));
    p = fma(p, w, (Reals)(1.0 / 7.0));
    p = fma(p, w, (Reals)(1.0 / 5.0));
    return fma(p, w, (Reals)(1.0 / 3.0));
}

// exp(r) for |r| <= ln(2) / 2
Reals exp_series(Reals r) {
    Reals p = 1.0 / 6227020800.0;
    p = fma(p, r, (Reals)(1.0 / 479001600.0));
    p = fma(p, r, (Reals)(1.0 / 39916800.0));
    p = fma(p, r, (Reals)(1.0 / 3628800.0));
    p = fma(p, r, (Reals)(1.0 / 362880.0));
    p = fma(p, r, (Reals)(1.0 / 40320.0));
    p = fma(p, r, (Reals)(1.0 / 5040.0));
    p = fma(p, r, (Reals)(1.0 / 720.0));
    p = fma(p, r, (Reals)(1.0 / 120.0));
    p = fma(p, r, (Reals)(1.0 / 24.0));
    p = fma(p, r, (Reals)(1.0 / 6.0));
    p = fma(p, r, (Reals)(0.5));
    return fma(fma(p, r, (Reals)1), r, (Reals)1);
}
#else
#define RT_EXP_LOWEST -87.0f
#define RT_LOG2_E 1.44269504f
#define RT_LN2_HIGH 0x1.62e4p-1f
#define RT_LN2_LOW 0x1.7f7d1cp-20f
#define RT_SQRT2 1.41421356f

Reals atanh_tail(Reals w) {
    Reals p = 1.0f / 9.0f;
    p = fma(p, w, (Reals)(1.0f / 7.0f));
    p = fma(p, w, (Reals)(1.0f / 5.0f));
    return fma(p, w, (Reals)(1.0f / 3.0f));
}

Reals exp_series(Reals r) {
    Reals p = 1.0f / 5040.0f;
    p = fma(p, r, (Reals)(1.0f / 720.0f));
    p = fma(p, r, (Reals)(1.0f / 120.0f));
    p = fma(p, r, (Reals)(1.0f / 24.0f));
    p = fma(p, r, (Reals)(1.0f / 6.0f));
    p = fma(p, r, (Reals)(0.5f));
    return fma(fma(p, r, (Reals)1), r, (Reals)1);
}
#endif

// 2 atanh(z) for |z| <= 0.172
Reals twice_atanh(Reals z) {
    Reals w = z * z;
    Reals twice = (Reals)2 * z;
    return fma(twice * w, atanh_tail(w), twice);
}

// log(cosine) for 0 < cosine <= 1, subnormal ones included; from gap = 1 - cosine where the cosine
// is above 13/16. Both are a multiple of log(2) and 2 atanh of a ratio.
Reals log_cosine(Reals cosine, Reals gap) {
    Mask subnormal = cosine < (Reals)RT_MIN_NORMAL;
    Indices shift = subnormal ? (Indices)(RT_MANTISSA_BITS + 1) : (Indices)0;
    Reals x = subnormal ? cosine * power_of_two((Indices)(RT_MANTISSA_BITS + 1)) : cosine;
    Reals m = mantissa_of(x);
    Mask large = m > (Reals)RT_SQRT2;
    m = large ? m * (Reals)0.5 : m;
    Indices exponent = exponent_of(x) - shift + (large ? (Indices)1 : (Indices)0);
    Mask near = cosine > (Reals)0.8125;
    Reals k = near ? (Reals)0 : RT_TO_REALS(exponent);
    Reals above = near ? -gap : m - (Reals)1;
    Reals below = near ? (Reals)2 - gap : m + (Reals)1;
    Reals log_m = twice_atanh(above / below);
    return fma(k, (Reals)RT_LN2_HIGH, fma(k, (Reals)RT_LN2_LOW, log_m));
}

// exp(y) for y <= 0; 0 where the result would not be a normal number
Reals exp_negative(Reals y) {
    Mask normal = y > (Reals)RT_EXP_LOWEST;
    y = normal ? y : (Reals)0;
    Indices k = RT_TO_INDICES(y * (Reals)RT_LOG2_E - (Reals)0.5);
    Reals minus_k = RT_TO_REALS(-k);
    Reals r = fma(minus_k, (Reals)RT_LN2_HIGH, y);
    r = fma(minus_k, (Reals)RT_LN2_LOW, r);
    return normal ? exp_series(r) * power_of_two(k) : (Reals)0;
}

// max(0, n.h)^exponent for unit n and h; half_gap is |n - h|^2 / 2. 0^0 is 1.
Reals blinn_lobe(Reals n_dot_h, Reals half_gap, Reals exponent) {
    Mask lit = n_dot_h > (Reals)0;
    Reals lobe = exp_negative(exponent * log_cosine(n_dot_h, half_gap));
    lobe = lit ? lobe : (Reals)0;
    return exponent == (Reals)0 ? (Reals)1 : lobe;
}

#endif
