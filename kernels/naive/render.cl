// SPDX-License-Identifier: Apache-2.0
//
// The entry points with textbook formulas in place of robust ones, a switch for each technique:
// what robustness costs and gains on a device (mirrorball stress --cost, --without). Each file here
// includes one of the kernels' with the functions to be replaced under other names, after the naive
// files that stand for what that one includes, and then defines its own; so the kernels themselves
// know nothing of this.
#include "kernels/builtins.h"  // before the attributes below, which are not for declarations

#ifdef __clang__
#pragma clang attribute push(__attribute__((always_inline)), apply_to = function)
#endif

#include "kernels/naive/bvh.cl"
#include "kernels/naive/camera.cl"
#include "kernels/naive/closest_hit.cl"
#include "kernels/naive/hit_surface.cl"
#include "kernels/naive/intersect.cl"
#include "kernels/naive/power.cl"

#ifdef __clang__
#pragma clang attribute pop
#endif

#include "kernels/render.cl"
