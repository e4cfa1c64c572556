// SPDX-License-Identifier: Apache-2.0
//
// The types of a program. Real is float, or double with -DRT_DOUBLE=1. A work item traces a packet
// of RT_LANES rays, one per lane: Real and Index are shared by all lanes, Reals and Indices hold
// one number per lane, Mask says in which lanes a condition holds. With one lane (GPUs) they are
// scalars. real3 lives in registers, memory holds Packed3. real3 is three numbers, not the built-in
// vector: Intel's CPU compiler gets the built-in one wrong when it vectorizes across work items
// (components land in the next pixel).
// Contraction is off for the whole program: with + - * / sqrt and explicit fma alone, every device
// and every lane rounds the same way and every picture has one set of bits (docs/design.md, "Strict
// arithmetic"). -DRT_FAST_MATH=1 lets the compiler contract.
#ifndef RT_TYPES_H
#define RT_TYPES_H

#ifndef RT_FAST_MATH
#pragma OPENCL FP_CONTRACT OFF
#endif

#define RT_JOIN2(a, b) a##b
#define RT_JOIN(a, b) RT_JOIN2(a, b)
#define RT_STATIC_ASSERT(condition) \
    typedef char RT_JOIN(rt_assert_, __LINE__)[(condition) ? 1 : -1] __attribute__((unused))

#define RT_COUNT ulong
#ifdef RT_DOUBLE
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#define RT_REAL double
#define RT_INDEX long
#define RT_ROUNDOFF 0x1p-53  // half an ulp of 1
#define RT_LARGEST DBL_MAX
#define RT_LEAST_DIRECTION 0x1p-523  // no position divided by it overflows (host/flatten)
#else
#define RT_REAL float
#define RT_INDEX int
#define RT_ROUNDOFF 0x1p-24f
#define RT_LARGEST FLT_MAX
#define RT_LEAST_DIRECTION 0x1p-67f
#endif

#ifndef RT_LANES
#define RT_LANES 1
#endif
#if RT_LANES == 1
#define RT_LANES_OF(type) type
#else
#define RT_LANES_OF(type) RT_JOIN(type, RT_LANES)
#endif

#include "kernels/shared.h"

typedef RT_LANES_OF(RT_REAL) Reals;
typedef RT_LANES_OF(RT_INDEX) Indices;
typedef RT_LANES_OF(uint) Uints;

// The result of comparing Reals: 1 or 0; with several lanes -1 or 0. Combine with & | !, reduce
// with lanes.h, select with `mask ? a : b`.
#if RT_LANES == 1
typedef int Mask;
#define RT_ALL_LANES ((Mask)1)
#else
typedef Indices Mask;
#define RT_ALL_LANES ((Mask)-1)
#endif
#define RT_NO_LANES ((Mask)0)

#define RT_TO_REALS RT_JOIN(convert_, RT_LANES_OF(RT_REAL))
#define RT_TO_INDICES RT_JOIN(convert_, RT_LANES_OF(RT_INDEX))
#define RT_TO_UINTS RT_JOIN(convert_, RT_LANES_OF(uint))

typedef struct {
    Reals x, y, z;
} real3;

#endif
