// SPDX-License-Identifier: Apache-2.0
//
// The feature switches of kernels/features.h as a variable, so that one build renders with every
// set of them (tests/switches_test.cpp).
extern __constant int rt_switches;
#define RT_SWITCHES rt_switches
#define RT_RENDERS_EDGES 1
