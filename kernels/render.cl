// SPDX-License-Identifier: Apache-2.0
//
// The entry points of OpenCL devices (kernels/items.cl says what a work item does). counts has one
// slot per work item, accumulated over launches. A program holds only those launched
// (RT_RENDERS_..), since each compiles the whole tracer again. RT_ITEM is on the functions they
// call: PoCL makes three copies of a kernel, so there these stay calls (host/opencl/pocl.h). A GPU
// would copy their arguments to its slow memory, so elsewhere they are inlined at any size.

#include "kernels/features.h"

// Where several kernels of a program hold the tracer, it stays a call for PoCL, too: inlined, it is
// a few percent faster, but takes up to twice as long to compile.
#ifndef RT_ITEM
#define RT_ITEM __attribute__((always_inline))
#elif !RT_RENDERS_PIXELS && !RT_RENDERS_SAMPLES
#define RT_OUT_OF_LINE RT_ITEM
#endif

#include "kernels/items.cl"

#define RT_SCENE_ARGUMENT(type, name, what) __global const type *restrict name,
#define RT_SCENE_ARGUMENTS RT_SCENE_ARRAYS(RT_SCENE_ARGUMENT) LaunchParams params
#define RT_SCENE_PASSED(type, name, what) __global const type *name,
#define RT_SCENE_PARAMETERS RT_SCENE_ARRAYS(RT_SCENE_PASSED) LaunchParams params

#define RT_SCENE_NAME(type, name, what) name,
#define RT_SCENE_NAMES RT_SCENE_ARRAYS(RT_SCENE_NAME) params
#define RT_SCENE_VIEW \
    { RT_SCENE_NAMES }

#if RT_RENDERS_PIXELS
static RT_ITEM void one_of_pixels(__global Real* film, __global RayCounts* counts,
                                  RT_SCENE_PARAMETERS, Tile tile, size_t item) {
    SceneView scene = RT_SCENE_VIEW;
    add_counts(counts, item, pixels_item(film, &scene, &tile, (Index)item, RT_SAMPLES_TOGETHER));
}

__kernel void render_pixels(__global Real* restrict film, __global RayCounts* restrict counts,
                            RT_SCENE_ARGUMENTS, Tile tile) {
    one_of_pixels(film, counts, RT_SCENE_NAMES, tile, get_global_id(0));
}
#endif

#if RT_RENDERS_SAMPLES
static RT_ITEM void one_of_samples(__global Real* samples, __global RayCounts* counts,
                                   RT_SCENE_PARAMETERS, Tile tile, size_t item) {
    SceneView scene = RT_SCENE_VIEW;
    add_counts(counts, item,
               samples_item(samples, &scene, &tile, (Index)item, RT_SAMPLES_TOGETHER));
}

__kernel void render_samples(__global Real* restrict samples, __global RayCounts* restrict counts,
                             RT_SCENE_ARGUMENTS, Tile tile) {
    one_of_samples(samples, counts, RT_SCENE_NAMES, tile, get_global_id(0));
}

__kernel void resolve_samples(__global Real* restrict film, __global const Real* restrict samples,
                              LaunchParams params, Tile tile) {
    resolve_item(film, samples, &params, &tile, (Index)get_global_id(0));
}
#endif

#if RT_RENDERS_ADAPTIVE || RT_RENDERS_EDGES
static RT_ITEM void one_of_centers(__global Real* planes, __global RayCounts* counts,
                                   RT_SCENE_PARAMETERS, Tile tile, size_t item) {
    SceneView scene = RT_SCENE_VIEW;
    add_counts(counts, item, centers_item(planes, &scene, &tile, (Index)item));
}

__kernel void render_centers(__global Real* restrict planes, __global RayCounts* restrict counts,
                             RT_SCENE_ARGUMENTS, Tile tile) {
    one_of_centers(planes, counts, RT_SCENE_NAMES, tile, get_global_id(0));
}

static RT_ITEM void one_of_round(__global Real* film, __global RayCounts* counts,
                                 RT_SCENE_PARAMETERS, Tile tile, __global Real* planes, Index round,
                                 size_t item) {
    SceneView scene = RT_SCENE_VIEW;
    add_counts(counts, item, round_item(film, planes, &scene, &tile, round, (Index)item));
}

__kernel void render_round(__global Real* restrict film, __global RayCounts* restrict counts,
                           RT_SCENE_ARGUMENTS, Tile tile, __global Real* restrict planes,
                           Index round) {
    one_of_round(film, counts, RT_SCENE_NAMES, tile, planes, round, get_global_id(0));
}
#endif

#if RT_TRACES_RAYS
static RT_ITEM void one_of_rays(__global RayAnswer* answers, __global const RayQuery* queries,
                                RT_SCENE_PARAMETERS, Index count, size_t item) {
    SceneView scene = RT_SCENE_VIEW;
    rays_item(answers, queries, &scene, count, (Index)item);
}

__kernel void trace_rays(__global RayAnswer* restrict answers,
                         __global const RayQuery* restrict queries, RT_SCENE_ARGUMENTS,
                         Index count) {
    size_t item = get_global_id(0);
    if (item * RT_LANES < count) {
        one_of_rays(answers, queries, RT_SCENE_NAMES, count, item);
    }
}
#endif

// Adds the slots of counts from `kept` on to those before, one work item for each of these: all
// would be too many to read back from a GPU.
__kernel void sum_counts(__global RayCounts* counts, Index slots, Index kept) {
    Index item = (Index)get_global_id(0);
    for (Index slot = item + kept; slot < slots; slot += kept) {
        RayCounts used = counts[slot], none = {0, 0, 0, 0};
        add_counts(counts, item, used);
        counts[slot] = none;
    }
}
