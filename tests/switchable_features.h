// SPDX-License-Identifier: Apache-2.0
//
// The feature switches of kernels/features.h as variables, in the same order, so that one build
// renders with every set of them (tests/switches_test.cpp).
extern __constant int rt_switches[13];
#define RT_HAS_SPHERES rt_switches[0]
#define RT_HAS_HUGE_SPHERES rt_switches[1]
#define RT_HAS_EYE_ON_SURFACE rt_switches[2]
#define RT_HAS_CONES rt_switches[3]
#define RT_HAS_TRIANGLES rt_switches[4]
#define RT_HAS_VERTEX_NORMALS rt_switches[5]
#define RT_HAS_HIERARCHY rt_switches[6]
#define RT_HAS_LIGHTS rt_switches[7]
#define RT_HAS_MIRRORS rt_switches[8]
#define RT_HAS_GLASS rt_switches[9]
#define RT_HAS_SOBOL rt_switches[10]
#define RT_HAS_FILTERS rt_switches[11]
#define RT_HAS_EDGES rt_switches[12]
#define RT_RENDERS_EDGES 1
#define RT_FEATURE_BITS 0x1fff
