// SPDX-License-Identifier: Apache-2.0
//
// The types of a program: Real is float, or double with -DRT_DOUBLE=1; real3 lives in registers,
// memory holds Packed3. real3 is three scalars, not the built-in vector: Intel's CPU compiler gets
// the built-in one wrong when it vectorises across work items (components land in the next pixel).
// Contraction is off for the whole program: with + - * / sqrt and
// explicit fma alone, every device rounds the same way and the picture has one set of bits
// (docs/design.md, "Strict arithmetic"). -DRT_FAST_MATH=1 lets the compiler contract.
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
#else
#define RT_REAL float
#define RT_INDEX int
#define RT_ROUNDOFF 0x1p-24f
#endif

#include "kernels/shared.h"

typedef struct {
    Real x, y, z;
} real3;

#endif
