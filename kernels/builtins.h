// SPDX-License-Identifier: Apache-2.0
//
// The built-in functions of OpenCL C that kernels call, declared as Clang's opencl-c.h does, for
// compilers made to leave that header out (RT_DECLARES_BUILTINS, host/opencl/pocl.h).
#ifndef RT_BUILTINS_H
#define RT_BUILTINS_H

#include "kernels/types.h"

#ifdef RT_DECLARES_BUILTINS

// Clang warns each time that a packet wider than the processor's vectors is passed.
#pragma clang diagnostic ignored "-Wpsabi"

#define RT_BUILTIN __attribute__((overloadable, const))

size_t RT_BUILTIN get_global_id(uint dimension);

#define RT_DECLARE_FMA(type) type RT_BUILTIN fma(type a, type b, type c)
RT_DECLARE_FMA(RT_REAL);
RT_DECLARE_FMA(RT_JOIN(RT_REAL, 2));
RT_DECLARE_FMA(RT_JOIN(RT_REAL, 4));
RT_DECLARE_FMA(RT_JOIN(RT_REAL, 8));
RT_DECLARE_FMA(RT_JOIN(RT_REAL, 16));

Reals RT_BUILTIN sqrt(Reals x);
Reals RT_BUILTIN fabs(Reals x);

#if RT_LANES != 1
Real RT_BUILTIN fabs(Real x);
#endif

// For compilers without reductions (kernels/lanes.h).
#if RT_LANES != 1
int RT_BUILTIN any(Mask mask);
#define RT_DECLARE_MIN(type) type RT_BUILTIN min(type a, type b)
RT_DECLARE_MIN(RT_INDEX);
RT_DECLARE_MIN(RT_JOIN(RT_INDEX, 2));
RT_DECLARE_MIN(RT_JOIN(RT_INDEX, 4));
RT_DECLARE_MIN(RT_JOIN(RT_INDEX, 8));
#endif

Reals RT_BUILTIN RT_TO_REALS(Indices v);
Reals RT_BUILTIN RT_TO_REALS(Uints v);
Indices RT_BUILTIN RT_TO_INDICES(Reals v);
Uints RT_BUILTIN RT_TO_UINTS(Indices v);

#endif

#endif
