// SPDX-License-Identifier: Apache-2.0
//
// Between packets and memory: which pixels of a tile a packet covers, and its colors lane by lane.
#ifndef RT_FILM_CL
#define RT_FILM_CL

#include "kernels/packet.cl"

void store3(__global Real* to, Index at, Real x, Real y, Real z) {
    to[3 * at] = x;
    to[3 * at + 1] = y;
    to[3 * at + 2] = z;
}

void add_counts(__global RayCounts* counts, size_t slot, RayCounts add) {
    counts[slot].primary += add.primary;
    counts[slot].shadow += add.shadow;
    counts[slot].mirror += add.mirror;
    counts[slot].transmitted += add.transmitted;
}

// The lanes' places in a tile for packet number `item`, columns and rows from its upper left
// corner; live if inside the tile.
typedef struct {
    Indices column, row;
    Mask live;
} TileLanes;

Index packets_across(const Tile* tile, const Packet* packet) {
    return (tile->width + packet->width - 1) / packet->width;
}

TileLanes tile_lanes(const Tile* tile, const Packet* packet, Index item) {
    Index across = packets_across(tile, packet);
    Indices down = packet->pixel >> packet->log_width;
    TileLanes lanes;
    lanes.column = item % across * packet->width + (packet->pixel & (packet->width - 1));
    lanes.row = item / across * packet->height + down;
    lanes.live = (Mask)((lanes.column < tile->width) & (lanes.row < tile->height));
    return lanes;
}

// The picture row, counted from the bottom, of a tile row. Terms common to all lanes come first:
// otherwise PoCL reads tile->y as part of a vector, wider than the store before it, and stalls (3 %
// of the paper's scene).
Indices picture_y(const LaunchParams* params, const Tile* tile, Indices row) {
    Index top = params->height - 1 - tile->y;
    return top - row;
}

// Stores the colors of the first `count` lanes at their places, skipping negative ones.
void store_lanes(__global Real* to, real3 color, Indices places, Index count) {
    RealLanes x, y, z;
    IndexLanes at;
    x.all = color.x;
    y.all = color.y;
    z.all = color.z;
    at.all = places;
    for (Index i = 0; i < count; ++i) {
        if (at.lane[i] >= 0) store3(to, at.lane[i], x.lane[i], y.lane[i], z.lane[i]);
    }
}

// The samples of a packet of pixels, at 3 x places.
real3 load_lanes(__global const Real* from, Indices places) {
    RealLanes x, y, z;
    IndexLanes at;
    at.all = places;
    for (Index i = 0; i < RT_LANES; ++i) {
        x.lane[i] = from[3 * at.lane[i]];
        y.lane[i] = from[3 * at.lane[i] + 1];
        z.lane[i] = from[3 * at.lane[i] + 2];
    }
    return make3(x.all, y.all, z.all);
}

#endif
