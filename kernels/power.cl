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
Real atanh_tail(Real w) {
    Real p = 1.0 / 23.0;
    p = fma(p, w, 1.0 / 21.0);
    p = fma(p, w, 1.0 / 19.0);
    p = fma(p, w, 1.0 / 17.0);
    p = fma(p, w, 1.0 / 15.0);
    p = fma(p, w, 1.0 / 13.0);
    p = fma(p, w, 1.0 / 11.0);
    p = fma(p, w, 1.0 / 9.0);
    p = fma(p, w, 1.0 / 7.0);
    p = fma(p, w, 1.0 / 5.0);
    return fma(p, w, 1.0 / 3.0);
}

// exp(r) for |r| <= ln(2) / 2
Real exp_series(Real r) {
    Real p = 1.0 / 6227020800.0;
    p = fma(p, r, 1.0 / 479001600.0);
    p = fma(p, r, 1.0 / 39916800.0);
    p = fma(p, r, 1.0 / 3628800.0);
    p = fma(p, r, 1.0 / 362880.0);
    p = fma(p, r, 1.0 / 40320.0);
    p = fma(p, r, 1.0 / 5040.0);
    p = fma(p, r, 1.0 / 720.0);
    p = fma(p, r, 1.0 / 120.0);
    p = fma(p, r, 1.0 / 24.0);
    p = fma(p, r, 1.0 / 6.0);
    p = fma(p, r, 0.5);
    return fma(fma(p, r, 1.0), r, 1.0);
}
#else
#define RT_EXP_LOWEST -87.0f
#define RT_LOG2_E 1.44269504f
#define RT_LN2_HIGH 0x1.62e4p-1f
#define RT_LN2_LOW 0x1.7f7d1cp-20f
#define RT_SQRT2 1.41421356f

Real atanh_tail(Real w) {
    Real p = 1.0f / 9.0f;
    p = fma(p, w, 1.0f / 7.0f);
    p = fma(p, w, 1.0f / 5.0f);
    return fma(p, w, 1.0f / 3.0f);
}

Real exp_series(Real r) {
    Real p = 1.0f / 5040.0f;
    p = fma(p, r, 1.0f / 720.0f);
    p = fma(p, r, 1.0f / 120.0f);
    p = fma(p, r, 1.0f / 24.0f);
    p = fma(p, r, 1.0f / 6.0f);
    p = fma(p, r, 0.5f);
    return fma(fma(p, r, 1.0f), r, 1.0f);
}
#endif

// 2 atanh(z) for |z| <= 0.172
Real twice_atanh(Real z) {
    Real w = z * z;
    Real twice = (Real)2 * z;
    return fma(twice * w, atanh_tail(w), twice);
}

// log(1 - s) for 0 <= s <= 0.2
Real log_one_minus(Real s) { return -twice_atanh(s / ((Real)2 - s)); }

// log(x) for 0 < x <= 1, subnormal x included
Real log_unit(Real x) {
    Index shift = 0;
    if (x < (Real)RT_MIN_NORMAL) {
        shift = RT_MANTISSA_BITS + 1;
        x *= power_of_two(shift);
    }
    Index exponent = exponent_of(x) - shift;
    Real m = mantissa_of(x);
    if (m > (Real)RT_SQRT2) {
        m *= (Real)0.5;
        exponent += 1;
    }
    Real k = (Real)exponent;
    Real log_m = twice_atanh((m - (Real)1) / (m + (Real)1));
    return fma(k, (Real)RT_LN2_HIGH, fma(k, (Real)RT_LN2_LOW, log_m));
}

// exp(y) for y <= 0; 0 where the result would not be a normal number
Real exp_negative(Real y) {
    if (!(y > (Real)RT_EXP_LOWEST)) return (Real)0;
    Index k = (Index)(y * (Real)RT_LOG2_E - (Real)0.5);
    Real r = fma((Real)-k, (Real)RT_LN2_HIGH, y);
    r = fma((Real)-k, (Real)RT_LN2_LOW, r);
    return exp_series(r) * power_of_two(k);
}

// max(0, n.h)^exponent for unit n and h; half_gap is |n - h|^2 / 2. 0^0 is 1.
Real blinn_lobe(Real n_dot_h, Real half_gap, Real exponent) {
    if (exponent == (Real)0) return (Real)1;
    if (!(n_dot_h > (Real)0)) return (Real)0;
    Real log_cosine = n_dot_h > (Real)0.8125 ? log_one_minus(half_gap) : log_unit(n_dot_h);
    return exp_negative(exponent * log_cosine);
}

#endif
