// SPDX-License-Identifier: Apache-2.0
//
// The probes as plain functions, compiled ahead of time like the pthreads kernels
// (tests/CMakeLists.txt): one packet per call, its number given as `first`.
#define RT_OUT_OF_LINE __attribute__((noinline))
#define __kernel

static size_t get_global_id(uint dimension) { return 0; }

#include "kernels/probes/probes.cl"
