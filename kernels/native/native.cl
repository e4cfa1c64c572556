// SPDX-License-Identifier: Apache-2.0
//
// The entry points for pthreads: the same work items (kernels/items.cl) in loops, compiled ahead of
// time to machine code (cmake/native_kernels.cmake). Each variant has its own prefix,
// RT_NATIVE_NAME. The scene is passed as a SceneView; counts is a single slot, added to.
#define RT_OUT_OF_LINE __attribute__((noinline))

#include "kernels/items.cl"

#define RT_NATIVE(function) RT_JOIN(RT_NATIVE_NAME, function)

// An entry point's body: calls a function for each `item`, with a copy of the `scene`.
#define RT_FOR_ITEMS(call)   \
    SceneView scene = *view; \
    for (Index item = first; item < end; ++item) add_counts(counts, 0, call)

// What this variant is (NativeVariant, host/render/native_kernels.h).
__constant int RT_NATIVE(_traits)[] = {RT_FEATURE_BITS, RT_LANES, RT_SAMPLES};

void RT_NATIVE(_pixels)(__global Real* film, __global RayCounts* counts, const SceneView* view,
                        const Tile* tile, Index first, Index end) {
    RT_FOR_ITEMS(pixels_item(film, &scene, tile, item, RT_SAMPLES_TOGETHER));
}

// For tiles of one pixel.
void RT_NATIVE(_pixel)(__global Real* film, __global RayCounts* counts, const SceneView* view,
                       const Tile* tile, Index first, Index end) {
    RT_FOR_ITEMS(pixels_item(film, &scene, tile, item, RT_LANES));
}

void RT_NATIVE(_samples)(__global Real* samples, __global RayCounts* counts, const SceneView* view,
                         const Tile* tile, Index first, Index end) {
    RT_FOR_ITEMS(samples_item(samples, &scene, tile, item, 1));
}

void RT_NATIVE(_resolve)(__global Real* film, __global const Real* samples,
                         const LaunchParams* params, const Tile* tile, Index first, Index end) {
    for (Index item = first; item < end; ++item) resolve_item(film, samples, params, tile, item);
}

#if RT_RENDERS_ADAPTIVE || RT_RENDERS_EDGES
void RT_NATIVE(_centers)(__global Real* planes, __global RayCounts* counts, const SceneView* view,
                         const Tile* tile, Index first, Index end) {
    RT_FOR_ITEMS(centers_item(planes, &scene, tile, item));
}

void RT_NATIVE(_round)(__global Real* film, __global RayCounts* counts, const SceneView* view,
                       const Tile* tile, __global Real* planes, Index round, Index first,
                       Index end) {
    RT_FOR_ITEMS(round_item(film, planes, &scene, tile, round, item));
}
#endif

#if RT_TRACES_RAYS
void RT_NATIVE(_rays)(__global RayAnswer* answers, __global const RayQuery* queries,
                      const SceneView* scene, Index count, Index first, Index end) {
    for (Index item = first; item < end; ++item) {
        rays_item(answers, queries, scene, count, item);
    }
}
#endif
