// SPDX-License-Identifier: Apache-2.0
//
// OpenCL C for native CPU code: the types and built-in functions that kernels use and that clang
// leaves to a driver's header. Included before everything else (cmake/native_kernels.cmake). fma,
// sqrt and fabs are exact or correctly rounded, as on every device; without hardware fma, the C
// library's is called.
#ifndef RT_OPENCL_C_H
#define RT_OPENCL_C_H

typedef unsigned int uint;
typedef unsigned long ulong;
typedef unsigned long size_t;

#define RT_VECTORS(type)                                      \
    typedef type type##2 __attribute__((ext_vector_type(2))); \
    typedef type type##4 __attribute__((ext_vector_type(4))); \
    typedef type type##8 __attribute__((ext_vector_type(8))); \
    typedef type type##16 __attribute__((ext_vector_type(16)));
RT_VECTORS(int)
RT_VECTORS(uint)
RT_VECTORS(long)
RT_VECTORS(float)
RT_VECTORS(double)

#define INFINITY __builtin_inff()
#define FLT_MAX 0x1.fffffep127f
#define DBL_MAX 0x1.fffffffffffffp1023
#define INT_MAX 0x7fffffff
#define LONG_MAX 0x7fffffffffffffffL

#define RT_BUILTIN_HERE static __attribute__((overloadable, always_inline, const))
#if defined(__FMA__) || defined(__ARM_FEATURE_FMA)
#define RT_FMA_HERE RT_BUILTIN_HERE
#else
#define RT_FMA_HERE static __attribute__((overloadable, noinline, const))  // one call per lane
#endif

// For one width and precision: numbers, their integers, and unsigned 32-bit integers.
#define RT_DEFINE_BUILTINS(real, index, uints)                                                  \
    RT_FMA_HERE real fma(real a, real b, real c) { return __builtin_elementwise_fma(a, b, c); } \
    RT_BUILTIN_HERE real sqrt(real x) { return __builtin_elementwise_sqrt(x); }                 \
    RT_BUILTIN_HERE real fabs(real x) { return __builtin_elementwise_abs(x); }                  \
    RT_BUILTIN_HERE index as_##index(real x) { return __builtin_astype(x, index); }             \
    RT_BUILTIN_HERE real as_##real(index x) { return __builtin_astype(x, real); }

#define RT_DEFINE_CONVERSIONS(real, index, uints)                                               \
    RT_BUILTIN_HERE real convert_##real(index v) { return __builtin_convertvector(v, real); }   \
    RT_BUILTIN_HERE real convert_##real(uints v) { return __builtin_convertvector(v, real); }   \
    RT_BUILTIN_HERE index convert_##index(real v) { return __builtin_convertvector(v, index); } \
    RT_BUILTIN_HERE uints convert_##uints(index v) { return __builtin_convertvector(v, uints); }

#define RT_DEFINE_WIDTH(width)                                   \
    RT_DEFINE_BUILTINS(float##width, int##width, uint##width)    \
    RT_DEFINE_BUILTINS(double##width, long##width, uint##width)  \
    RT_DEFINE_CONVERSIONS(float##width, int##width, uint##width) \
    RT_DEFINE_CONVERSIONS(double##width, long##width, uint##width)

RT_DEFINE_BUILTINS(float, int, uint)
RT_DEFINE_BUILTINS(double, long, uint)
RT_DEFINE_WIDTH(2)
RT_DEFINE_WIDTH(4)
RT_DEFINE_WIDTH(8)
RT_DEFINE_WIDTH(16)

RT_BUILTIN_HERE float convert_float(int v) { return (float)v; }
RT_BUILTIN_HERE float convert_float(uint v) { return (float)v; }
RT_BUILTIN_HERE double convert_double(long v) { return (double)v; }
RT_BUILTIN_HERE double convert_double(uint v) { return (double)v; }
RT_BUILTIN_HERE int convert_int(float v) { return (int)v; }
RT_BUILTIN_HERE long convert_long(double v) { return (long)v; }
RT_BUILTIN_HERE uint convert_uint(int v) { return (uint)v; }
RT_BUILTIN_HERE uint convert_uint(long v) { return (uint)v; }

#endif
