// SPDX-License-Identifier: Apache-2.0
//
// Blinn's lobe by the built-in power of n.h.
#ifndef RT_NAIVE_POWER_CL
#define RT_NAIVE_POWER_CL

#include "kernels/naive/techniques.h"

#if RT_NAIVE_LOBE
#define blinn_lobe robust_blinn_lobe
#endif
#include "kernels/power.cl"
#undef blinn_lobe

#if RT_NAIVE_LOBE
Reals blinn_lobe(Reals along, Reals across, Reals squared, Reals exponent) {
    Reals n_dot_h = along / sqrt(squared);
    return n_dot_h > (Reals)0 ? pow(n_dot_h, exponent) : (Reals)0;
}
#endif

#endif
