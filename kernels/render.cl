// SPDX-License-Identifier: Apache-2.0
//
// The entry points of OpenCL devices (kernels/items.cl says what a work item does). counts has one
// slot a work item and is added to launch after launch. A program holds those that are launched
// (RT_RENDERS_..): each is built from the whole tracer again.

#include "kernels/items.cl"

#define RT_SCENE_ARGUMENT(type, name, what) __global const type *restrict name,
#define RT_SCENE_ARGUMENTS RT_SCENE_ARRAYS(RT_SCENE_ARGUMENT) LaunchParams params

#define RT_SCENE_NAME(type, name, what) name,
#define RT_SCENE_VIEW \
    { RT_SCENE_ARRAYS(RT_SCENE_NAME) params }

#if RT_RENDERS_PIXELS
__kernel void render_pixels(__global Real* restrict film, __global RayCounts* restrict counts,
                            RT_SCENE_ARGUMENTS, Tile tile) {
    SceneView scene = RT_SCENE_VIEW;
    size_t item = get_global_id(0);
    add_counts(counts, item, pixels_item(film, &scene, &tile, (Index)item));
}
#endif

#if RT_RENDERS_SAMPLES
__kernel void render_samples(__global Real* restrict samples, __global RayCounts* restrict counts,
                             RT_SCENE_ARGUMENTS, Tile tile) {
    SceneView scene = RT_SCENE_VIEW;
    size_t item = get_global_id(0);
    add_counts(counts, item,
               samples_item(samples, &scene, &tile, (Index)item, RT_SAMPLES_TOGETHER));
}

__kernel void resolve_samples(__global Real* restrict film, __global const Real* restrict samples,
                              LaunchParams params, Tile tile) {
    resolve_item(film, samples, &params, &tile, (Index)get_global_id(0));
}
#endif

#if RT_RENDERS_LIST
__kernel void render_list(__global Real* restrict colors, __global RayCounts* restrict counts,
                          RT_SCENE_ARGUMENTS, Tile tile, __global const int* restrict pixels) {
    SceneView scene = RT_SCENE_VIEW;
    size_t item = get_global_id(0);
    add_counts(counts, item, list_item(colors, pixels, &scene, &tile, (Index)item));
}
#endif

#if RT_TRACES_RAYS
__kernel void trace_rays(__global RayAnswer* restrict answers,
                         __global const RayQuery* restrict queries, RT_SCENE_ARGUMENTS,
                         Index count) {
    SceneView scene = RT_SCENE_VIEW;
    Index item = (Index)get_global_id(0);
    if (item * RT_LANES < count) rays_item(answers, queries, &scene, count, item);
}
#endif
