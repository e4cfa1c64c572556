// SPDX-License-Identifier: Apache-2.0
//
// The entry points. A work item is a packet of pixels with all their samples (render_pixels;
// render_listed for chosen pixels) or a packet of samples (render_samples, averaged by
// resolve_samples); all add a pixel's samples in the same order, so they give the same bits. The
// film holds three Reals a pixel, row 0 at the top. counts has one slot a work item and is added to
// launch after launch. A program holds those that are launched (RT_RENDERS_..): each is built anew
// from the whole tracer.

#include "kernels/builtins.h"  // before the attributes below, which are not for declarations

// Many small functions on structs: 1.35 times faster on PoCL when all are inlined, which it does
// not do by itself. Without linkage to other programs they then vanish, and PoCL loads the built
// program in two thirds of the time.
#ifdef __clang__
#pragma clang attribute push(__attribute__((always_inline)), apply_to = function)
#if __has_attribute(internal_linkage)
#pragma clang attribute push(__attribute__((internal_linkage)), apply_to = function)
#endif
#endif

#include "kernels/film.cl"

#ifdef __clang__
#if __has_attribute(internal_linkage)
#pragma clang attribute pop
#endif
#pragma clang attribute pop
#endif

#define RT_SCENE_ARGUMENTS                                                                  \
    __global const Sphere *restrict spheres, __global const Cone *restrict cones,           \
        __global const Triangle *restrict triangles,                                        \
        __global const VertexNormals *restrict vertex_normals,                              \
        __global const Material *restrict materials, __global const Light *restrict lights, \
        __global const BvhNode *restrict nodes, __global const Index *restrict listed,      \
        __global const Index *restrict casters, Frame frame

#define RT_SCENE_VIEW \
    { spheres, cones, triangles, vertex_normals, materials, lights, nodes, listed, casters, frame }

#if RT_RENDERS_PIXELS
__kernel void render_pixels(__global Real* restrict film, __global RayCounts* restrict counts,
                            RT_SCENE_ARGUMENTS, Tile tile) {
    size_t item = get_global_id(0);
    if (RT_SAMPLES != 0) frame.samples = RT_SAMPLES;
    Packet packet = make_packet(frame.samples, RT_SAMPLES_TOGETHER);
    TileLanes lanes = tile_lanes(&tile, &packet, (Index)item);
    if (!any_lane(lanes.live)) return;
    SceneView scene = RT_SCENE_VIEW;
    RayCounts used = {0, 0, 0};
    real3 color = trace_pixels(&scene, &packet, tile.x + lanes.column,
                               picture_y(&frame, &tile, lanes.row), lanes.live, &used);
    Indices places = tile.first + lanes.row * tile.film_width + lanes.column;
    store_lanes(film, color, lanes.live ? places : (Indices)-1, packet.pixels);
    add_counts(counts, item, used);
}
#endif

#if RT_RENDERS_SAMPLES
// Sample k of the tile's pixel i goes to samples[k * pixels + i].
__kernel void render_samples(__global Real* restrict samples, __global RayCounts* restrict counts,
                             RT_SCENE_ARGUMENTS, Tile tile) {
    size_t item = get_global_id(0);
    Packet packet = make_packet(frame.samples, RT_SAMPLES_TOGETHER);
    Index packets =
        packets_across(&tile, &packet) * ((tile.height + packet.height - 1) / packet.height);
    if (packets == 0) return;
    TileLanes lanes = tile_lanes(&tile, &packet, (Index)item % packets);
    Indices k = (Index)item / packets * packet.samples + packet.sample;
    lanes.live &= (Mask)(k < frame.samples);
    if (!any_lane(lanes.live)) return;
    SceneView scene = RT_SCENE_VIEW;
    PacketCounts used = {(Indices)0, (Indices)0, (Indices)0};
    real3 color = trace_sample(&scene, tile.x + lanes.column, picture_y(&frame, &tile, lanes.row),
                               k, lanes.live, &used);
    Indices places = (k * tile.height + lanes.row) * tile.width + lanes.column;
    store_lanes(samples, color, lanes.live ? places : (Indices)-1, RT_LANES);
    RayCounts sums = {0, 0, 0};
    count_lanes(&sums, &used);
    add_counts(counts, item, sums);
}

__kernel void resolve_samples(__global Real* restrict film, __global const Real* restrict samples,
                              Frame frame, Tile tile) {
    Packet packet = make_packet(1, 1);
    TileLanes lanes = tile_lanes(&tile, &packet, (Index)get_global_id(0));
    if (!any_lane(lanes.live)) return;
    Indices y = picture_y(&frame, &tile, lanes.row);
    real3 sum = make3((Reals)0, (Reals)0, (Reals)0);
    Reals total = (Reals)0;
    for (Index k = 0; k < frame.samples; ++k) {
        Reals weight = sample_weight(&frame, tile.x + lanes.column, y, (Indices)k);
        Indices places = (k * tile.height + lanes.row) * tile.width + lanes.column;
        real3 color = load_lanes(samples, lanes.live ? places : (Indices)0);
        sum = add_scaled(sum, weight, color);
        total += weight;
    }
    Indices places = tile.first + lanes.row * tile.film_width + lanes.column;
    store_lanes(film, divide3(sum, total), lanes.live ? places : (Indices)-1, RT_LANES);
}
#endif

#if RT_RENDERS_LISTED
// Chosen pixels, tile.width of them: pixels[i] counts through a film of tile.film_width columns
// whose upper left corner is pixel (tile.x, tile.y) of the picture. Pixel i goes to colors[i].
__kernel void render_listed(__global Real* restrict colors, __global RayCounts* restrict counts,
                            RT_SCENE_ARGUMENTS, Tile tile, __global const int* restrict pixels) {
    size_t item = get_global_id(0);
    Packet packet = make_packet(frame.samples, RT_LANES);
    Index first = (Index)item * packet.pixels;
    if (first >= tile.width) return;
    IndexLanes number, pixel;
    number.all = first + packet.pixel;
    for (Index i = 0; i < RT_LANES; ++i) {
        Index n = number.lane[i];
        pixel.lane[i] = pixels[n < tile.width ? n : tile.width - 1];
    }
    Indices row = pixel.all / tile.film_width;
    Indices column = pixel.all - row * tile.film_width;
    Mask live = (Mask)(number.all < tile.width);
    SceneView scene = RT_SCENE_VIEW;
    RayCounts used = {0, 0, 0};
    real3 color =
        trace_pixels(&scene, &packet, tile.x + column, picture_y(&frame, &tile, row), live, &used);
    store_lanes(colors, color, live ? number.all : (Indices)-1, packet.pixels);
    add_counts(counts, item, used);
}
#endif
