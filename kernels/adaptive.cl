// SPDX-License-Identifier: Apache-2.0
//
// An adaptive mode: one sample at each pixel's center. A pixel that differs from one of its eight
// neighbors by c (the largest channel difference, channels clamped to 0..1) beyond the threshold
// gets the coarsest grid of 2, 4, 8 or 16 samples per side, n, for which c / n is at most the
// threshold: the error of an edge pixel under an n x n grid is about c / n. A second round finds
// what such pixels revealed next to them.
#ifndef RT_ADAPTIVE_CL
#define RT_ADAPTIVE_CL

#include "kernels/planes.cl"

#define RT_FINEST_GRID 16

// Planes beyond those of kernels/planes.cl, which the first round leaves: the pixels' colors and
// grids.
enum { RT_FIRST_COLORS = 3, RT_FIRST_GRIDS = 6 };

Mask is_nan3(real3 v) { return (v.x != v.x) | (v.y != v.y) | (v.z != v.z); }

// How much the pixels x, y, which begin at `at` in these planes, differ from their neighbors in the
// picture; 1 near a NaN.
Reals contrasts(__global const Real* colors, const RowPacket* packet, const LaunchParams* params,
                Indices x, Indices y) {
    real3 own = load_colors(colors, packet->size, packet->at);
    Mask unknown = is_nan3(own);
    Reals contrast = (Reals)0;
    for (Index dy = -1; dy <= 1; ++dy) {
        for (Index dx = -1; dx <= 1; ++dx) {
            Mask inside = (x + dx >= 0) & (x + dx < params->width) & (y - dy >= 0) &
                          (y - dy < params->height);
            real3 color =
                load_colors(colors, packet->size, packet->at + dy * packet->wide.width + dx);
            color = select3(inside, color, own);
            unknown |= is_nan3(color);
            real3 difference = sub3(clamped3(color), clamped3(own));
            contrast = max_of(contrast, max_of(fabs(difference.x),
                                               max_of(fabs(difference.y), fabs(difference.z))));
        }
    }
    return unknown ? (Reals)1 : contrast;
}

// Samples per side for these contrasts; 1: no more than at the center.
Indices wanted_grids(Reals contrast, Real threshold) {
    Indices grids = contrast > (Reals)threshold ? (Indices)2 : (Indices)1;
    for (Index n = 2; n < RT_FINEST_GRID; n *= 2) {
        grids = contrast > (Reals)(threshold * (Real)n) ? (Indices)(2 * n) : grids;
    }
    return grids;
}

// Traces those pixels of a packet whose grid has n samples per side: in the tile's margin, or
// outside it. The first round's go to `planes`, the second's to the film.
void refine_pixels(__global Real* film, __global Real* planes, SceneView* scene, const Tile* tile,
                   const RowPacket* packet, Indices grids, Index n, bool in_margin, Index round,
                   RayCounts* counts) {
    IndexLanes grid, chosen;
    Index count = 0;
    grid.all = grids;
    for (Index i = 0; i < RT_LANES; ++i) {
        Index column = packet->column + i;
        bool is_margin = column < 0 || column >= tile->width || !packet->is_in_tile;
        if (grid.lane[i] == n && is_margin == in_margin) chosen.lane[count++] = i;
    }
    if (count == 0) return;
    scene->params.grid = n;
    scene->params.samples = n * n;
    Packet samples = make_packet(n * n, RT_LANES);
    RayCounts used = {0, 0, 0, 0};
    for (Index first = 0; first < count; first += samples.pixels) {
        IndexLanes number, column;
        number.all = first + samples.pixel;
        for (Index i = 0; i < RT_LANES; ++i) {
            column.lane[i] = chosen.lane[number.lane[i] < count ? number.lane[i] : count - 1];
        }
        Mask live = (Mask)(number.all < count);
        real3 color =
            trace_pixels(scene, &samples, tile->x + packet->column + column.all,
                         picture_y(&scene->params, tile, (Indices)packet->row), live, &used);
        live &= (Mask)(RT_LANE_NUMBERS < samples.pixels);
        if (round == 0) {
            store_colors(planes + RT_FIRST_COLORS * packet->size, packet->size, color,
                         live ? packet->at + column.all : (Indices)-1);
        } else {
            Index place = tile->first + packet->row * tile->film_width + packet->column;
            store_lanes(film, color, live ? place + column.all : (Indices)-1, RT_LANES);
        }
    }
    if (in_margin) return;  // counted by another tile
    counts->primary += (RT_COUNT)(count * n * n);
    counts->shadow += used.shadow;
    counts->mirror += used.mirror;
    counts->transmitted += used.transmitted;
}

// One round over a packet of pixels side by side.
RayCounts adaptive_item(__global Real* film, __global Real* planes, SceneView* scene,
                        const Tile* tile, Index round, Index item) {
    RayCounts sums = {0, 0, 0, 0};
    Index margin = RT_ADAPTIVE_MARGIN - 1 - round;
    RowPacket packet = row_packet(&scene->params, tile, margin, item);
    if (packet.row >= tile->height + margin || tile->height == 0) return sums;
    Indices columns = packet.column + RT_LANE_NUMBERS;
    Indices x = tile->x + columns, y = picture_y(&scene->params, tile, (Indices)packet.row);
    __global const Real* colors = planes + (round == 0 ? 0 : RT_FIRST_COLORS * packet.size);
    __global Real* first_grids = planes + RT_FIRST_GRIDS * packet.size;
    Indices grids =
        wanted_grids(contrasts(colors, &packet, &scene->params, x, y), scene->params.threshold);
    Mask inside = (x >= 0) & (x < scene->params.width) & (y >= 0) & (y < scene->params.height) &
                  (columns < packet.end);
    grids = inside ? grids : (Indices)0;
    real3 color = load_colors(colors, packet.size, packet.at);
    if (round == 0) {
        Indices places = columns < packet.end ? packet.at + RT_LANE_NUMBERS : (Indices)-1;
        store_colors(planes + RT_FIRST_COLORS * packet.size, packet.size, color, places);
        store_in_plane(first_grids, RT_TO_REALS(grids), places);
    } else {
        grids = load_row(first_grids + packet.at) > (Reals)1 ? (Indices)0 : grids;
        Indices places =
            tile->first + packet.row * tile->film_width + packet.column + RT_LANE_NUMBERS;
        store_lanes(film, color, columns < packet.end ? places : (Indices)-1, RT_LANES);
    }
    for (Index n = 2; n <= RT_FINEST_GRID; n *= 2) {
        for (Index part = 0; part < 2 - round; ++part) {
            refine_pixels(film, planes, scene, tile, &packet, grids, n, part != 0, round, &sums);
        }
    }
    scene->params.grid = scene->params.samples = 1;
    return sums;
}

#endif
