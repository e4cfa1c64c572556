// SPDX-License-Identifier: Apache-2.0
//
// The entry points. A work item is a pixel (render_pixels; render_listed for chosen ones) or a
// sample (render_samples, averaged by resolve_samples); all add a pixel's samples in the same
// order, so they give the same bits. The film holds three Reals a pixel, row 0 at the top. counts
// has one slot a work item and is added to launch after launch.

// Many small functions on structs: 1.35 times faster on PoCL when all are inlined, which it does
// not do by itself.
#ifdef __clang__
#pragma clang attribute push(__attribute__((always_inline)), apply_to = function)
#endif

#include "kernels/whitted.cl"

#ifdef __clang__
#pragma clang attribute pop
#endif

#define RT_SCENE_ARGUMENTS                                                                  \
    __global const Sphere *restrict spheres, __global const Triangle *restrict triangles,   \
        __global const VertexNormals *restrict vertex_normals,                              \
        __global const Material *restrict materials, __global const Light *restrict lights, \
        Frame frame

#define RT_SCENE_VIEW \
    { spheres, triangles, vertex_normals, materials, lights, frame }

void store3(__global Real* to, Index at, real3 color) {
    to[3 * at] = color.x;
    to[3 * at + 1] = color.y;
    to[3 * at + 2] = color.z;
}

void add_counts(__global RayCounts* counts, size_t slot, RayCounts add) {
    counts[slot].shadow += add.shadow;
    counts[slot].mirror += add.mirror;
}

// The pixel (x, y): its samples weighed and averaged, in their order.
real3 trace_pixel(const SceneView* scene, Index x, Index y, RayCounts* counts) {
    real3 sum = {0, 0, 0};
    Real total = 0;
    for (Index k = 0; k < scene->frame.samples; ++k) {
        Real weight = sample_weight(&scene->frame, x, y, k);
        sum = add_scaled(sum, weight, trace_sample(scene, x, y, k, counts));
        total += weight;
    }
    return divide3(sum, total);
}

__kernel void render_pixels(__global Real* restrict film, __global RayCounts* restrict counts,
                            RT_SCENE_ARGUMENTS, Tile tile) {
    size_t item = get_global_id(0);
    if (item >= (size_t)(tile.width * tile.height)) return;
    SceneView scene = RT_SCENE_VIEW;
    Index column = (Index)item % tile.width;
    Index row = (Index)item / tile.width;
    RayCounts used = {0, 0};
    real3 color = trace_pixel(&scene, tile.x + column, frame.height - 1 - (tile.y + row), &used);
    store3(film, tile.first + row * tile.film_width + column, color);
    add_counts(counts, item, used);
}

// Sample k of the tile's pixel i goes to samples[k * pixels + i].
__kernel void render_samples(__global Real* restrict samples, __global RayCounts* restrict counts,
                             RT_SCENE_ARGUMENTS, Tile tile) {
    size_t item = get_global_id(0);
    Index pixels = tile.width * tile.height;
    if (item >= (size_t)(pixels * frame.samples)) return;
    SceneView scene = RT_SCENE_VIEW;
    Index pixel = (Index)item % pixels;
    Index column = pixel % tile.width;
    Index row = pixel / tile.width;
    RayCounts used = {0, 0};
    real3 color = trace_sample(&scene, tile.x + column, frame.height - 1 - (tile.y + row),
                               (Index)item / pixels, &used);
    store3(samples, (Index)item, color);
    add_counts(counts, item, used);
}

__kernel void resolve_samples(__global Real* restrict film, __global const Real* restrict samples,
                              Frame frame, Tile tile) {
    size_t item = get_global_id(0);
    Index pixels = tile.width * tile.height;
    if (item >= (size_t)pixels) return;
    Index pixel = (Index)item;
    Index column = pixel % tile.width;
    Index row = pixel / tile.width;
    Index y = frame.height - 1 - (tile.y + row);
    real3 sum = {0, 0, 0};
    Real total = 0;
    for (Index k = 0; k < frame.samples; ++k) {
        Real weight = sample_weight(&frame, tile.x + column, y, k);
        Index at = 3 * (k * pixels + pixel);
        sum = add_scaled(sum, weight, make3(samples[at], samples[at + 1], samples[at + 2]));
        total += weight;
    }
    store3(film, tile.first + row * tile.film_width + column, divide3(sum, total));
}

// Chosen pixels, tile.width of them: pixels[i] counts through a film of tile.film_width columns
// whose upper left corner is pixel (tile.x, tile.y) of the picture. Pixel i goes to colors[i].
__kernel void render_listed(__global Real* restrict colors, __global RayCounts* restrict counts,
                            RT_SCENE_ARGUMENTS, Tile tile, __global const int* restrict pixels) {
    size_t item = get_global_id(0);
    if (item >= (size_t)tile.width) return;
    SceneView scene = RT_SCENE_VIEW;
    Index column = pixels[item] % tile.film_width;
    Index row = pixels[item] / tile.film_width;
    RayCounts used = {0, 0};
    real3 color = trace_pixel(&scene, tile.x + column, frame.height - 1 - (tile.y + row), &used);
    store3(colors, (Index)item, color);
    add_counts(counts, item, used);
}
