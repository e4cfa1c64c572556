// SPDX-License-Identifier: Apache-2.0
//
// What one work item does: trace a packet of pixels with all their samples (pixels_item), or a
// packet of samples (samples_item, averaged by resolve_item); in some modes more
// (kernels/planes.cl). All add a pixel's samples in the same order, so they give the same bits. The
// film holds three Reals per pixel, row 0 at the top. The entry points of render.cl and native.cl
// call these.
#ifndef RT_ITEMS_CL
#define RT_ITEMS_CL

#include "kernels/builtins.h"  // first: the attributes below must not apply to declarations

// Many small functions on structs: PoCL runs 1.35 times faster when all are inlined, which it does
// not do unasked. With internal linkage they then vanish, and PoCL loads the built program in two
// thirds of the time. NVIDIA's compiler inlines unasked; its clang 7 rejects the first pragma.
#if defined(__clang__) && __clang_major__ >= 12
#pragma clang attribute push(__attribute__((always_inline)), apply_to = function)
#pragma clang attribute push(__attribute__((internal_linkage)), apply_to = function)
#endif

#include "kernels/film.cl"
#if RT_RENDERS_ADAPTIVE || RT_RENDERS_EDGES
#include "kernels/planes.cl"
#endif
#if RT_RENDERS_ADAPTIVE
#include "kernels/adaptive.cl"
#endif
#if RT_RENDERS_EDGES
#include "kernels/edges.cl"
#endif
#if RT_TRACES_RAYS
#include "kernels/rays.cl"
#endif

// A packet holds at most most_samples of each of its pixels.
RayCounts pixels_item(__global Real* film, SceneView* scene, const Tile* tile, Index item,
                      Index most_samples) {
    RayCounts used = {0, 0, 0, 0};
    if (RT_SAMPLES != 0) scene->params.samples = RT_SAMPLES;
    Packet packet = make_packet(scene->params.samples, most_samples);
    TileLanes lanes = tile_lanes(tile, &packet, item);
    if (!any_lane(lanes.live)) return used;
    real3 color = trace_pixels(scene, &packet, tile->x + lanes.column,
                               picture_y(&scene->params, tile, lanes.row), lanes.live, &used);
    Indices places = tile->first + lanes.row * tile->film_width + lanes.column;
    store_lanes(film, color, lanes.live ? places : (Indices)-1, packet.pixels);
    return used;
}

// Likewise; sample k of the tile's pixel i goes to samples[k * pixels + i].
RayCounts samples_item(__global Real* samples, const SceneView* scene, const Tile* tile, Index item,
                       Index most_samples) {
    RayCounts sums = {0, 0, 0, 0};
    Packet packet = make_packet(scene->params.samples, most_samples);
    Index packets =
        packets_across(tile, &packet) * ((tile->height + packet.height - 1) / packet.height);
    if (packets == 0) return sums;
    TileLanes lanes = tile_lanes(tile, &packet, item % packets);
    Indices k = item / packets * packet.samples + packet.sample;
    lanes.live &= (Mask)(k < scene->params.samples);
    if (!any_lane(lanes.live)) return sums;
    PacketCounts used = no_counts();
    real3 color = trace_sample(scene, tile->x + lanes.column,
                               picture_y(&scene->params, tile, lanes.row), k, lanes.live, &used);
    Indices places = (k * tile->height + lanes.row) * tile->width + lanes.column;
    store_lanes(samples, color, lanes.live ? places : (Indices)-1, RT_LANES);
    count_lanes(&sums, &used);
    return sums;
}

void resolve_item(__global Real* film, __global const Real* samples, const LaunchParams* params,
                  const Tile* tile, Index item) {
    Packet packet = make_packet(1, 1);
    TileLanes lanes = tile_lanes(tile, &packet, item);
    if (!any_lane(lanes.live)) return;
    Indices y = picture_y(params, tile, lanes.row);
    Sum sum = empty_sum(), whole = sum;
    for (Index k = 0; k < params->samples; ++k) {
        begin_sample(&whole, &sum, k);
        Reals weight = sample_weight(params, tile->x + lanes.column, y, (Indices)k);
        Indices places = (k * tile->height + lanes.row) * tile->width + lanes.column;
        real3 color = load_lanes(samples, lanes.live ? places : (Indices)0);
        sum.color = add_scaled(sum.color, weight, color);
        sum.weight += weight;
    }
    whole = add_sums(whole, sum);
    Indices places = tile->first + lanes.row * tile->film_width + lanes.column;
    store_lanes(film, divide3(whole.color, whole.weight), lanes.live ? places : (Indices)-1,
                RT_LANES);
}

#if RT_RENDERS_ADAPTIVE || RT_RENDERS_EDGES
// One round of an adaptive or edges mode over a packet.
RayCounts round_item(__global Real* film, __global Real* planes, SceneView* scene, const Tile* tile,
                     Index round, Index item) {
#if RT_RENDERS_EDGES
    if (!RT_RENDERS_ADAPTIVE || scene->params.tolerance > (Real)0) {
        return edges_item(film, planes, scene, tile, round, item);
    }
#endif
#if RT_RENDERS_ADAPTIVE
    return adaptive_item(film, planes, scene, tile, round, item);
#endif
}
#endif

#if defined(__clang__) && __clang_major__ >= 12
#pragma clang attribute pop
#pragma clang attribute pop
#endif

#endif
