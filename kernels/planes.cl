// SPDX-License-Identifier: Apache-2.0
//
// What an adaptive or edges mode knows of a tile. First comes a sample of each pixel
// (centers_item), at its center or, in an edges mode, at its lower left corner. Then come rounds
// over packets of pixels side by side, each of which looks at the pixels around them
// (kernels/adaptive.cl, kernels/edges.cl).
//
// A tile brings along the pixels that its own depend on, in a margin around it. So a pixel depends
// on nothing but the scene.
#ifndef RT_PLANES_CL
#define RT_PLANES_CL

#include "kernels/film.cl"

Index tile_margin(const LaunchParams* params) {
    return RT_HAS(EDGES) && params->tolerance > (Real)0 ? RT_EDGE_MARGIN : RT_ADAPTIVE_MARGIN;
}

// The tile with `margin` pixels around it.
Tile with_margin(const Tile* tile, Index margin) {
    Tile wide = *tile;
    wide.x -= margin;
    wide.y -= margin;
    wide.width += 2 * margin;
    wide.height += 2 * margin;
    return wide;
}

// Each plane holds a number per pixel of a tile and its margin, with room for a packet behind it.
// The centers' three channels come first, then their signatures, in an edges mode.
enum { RT_SIGNATURES = 3 };

Index plane_size(const Tile* wide) { return wide->width * wide->height + RT_LANES; }

void store_in_plane(__global Real* plane, Reals values, Indices places) {
    RealLanes value;
    IndexLanes place;
    value.all = values;
    place.all = places;
    for (Index i = 0; i < RT_LANES; ++i) {
        if (place.lane[i] >= 0) plane[place.lane[i]] = value.lane[i];
    }
}

void store_colors(__global Real* planes, Index size, real3 colors, Indices places) {
    store_in_plane(planes, colors.x, places);
    store_in_plane(planes + size, colors.y, places);
    store_in_plane(planes + 2 * size, colors.z, places);
}

// A packet's numbers, at any place.
typedef Reals PlacedReals __attribute__((aligned(sizeof(Real))));

Reals load_row(__global const Real* from) { return *(__global const PlacedReals*)from; }

real3 load_colors(__global const Real* planes, Index size, Index at) {
    return make3(load_row(planes + at), load_row(planes + size + at),
                 load_row(planes + 2 * size + at));
}

Reals clamped(Reals v) { return min_of(max_of(v, (Reals)0), (Reals)1); }
real3 clamped3(real3 v) { return make3(clamped(v.x), clamped(v.y), clamped(v.z)); }

// Of a packet in a round that leaves `margin` pixels around the tile to look at: row and column
// from the tile's upper left pixel, and its place in a plane.
typedef struct {
    Tile wide;               // the tile and its margin
    Index row, column, end;  // the row ends before column `end`
    Index size, at;
    bool is_in_tile;  // its row is
} RowPacket;

RowPacket row_packet(const LaunchParams* params, const Tile* tile, Index margin, Index item) {
    RowPacket packet;
    Index around = tile_margin(params);
    packet.end = tile->width + margin;
    Index across = (packet.end + margin + RT_LANES - 1) / RT_LANES;
    packet.row = item / across - margin;
    packet.column = item % across * RT_LANES - margin;
    packet.wide = with_margin(tile, around);
    packet.size = plane_size(&packet.wide);
    packet.at = (packet.row + around) * packet.wide.width + packet.column + around;
    packet.is_in_tile = packet.row >= 0 && packet.row < tile->height;
    return packet;
}

// The first sample of each pixel of a packet, margin included.
RayCounts centers_item(__global Real* planes, const SceneView* scene, const Tile* tile,
                       Index item) {
    RayCounts sums = {0, 0, 0, 0};
    Index margin = tile_margin(&scene->params);
    Tile wide = with_margin(tile, margin);
    Packet packet = make_packet(1, 1);
    TileLanes lanes = tile_lanes(&wide, &packet, item);
    if (!any_lane(lanes.live) || tile->height == 0) return sums;
    PacketCounts used = no_counts();
    Sum sum = empty_sum(), whole = sum;
    add_packet(scene, &packet, wide.x + lanes.column, picture_y(&scene->params, &wide, lanes.row),
               0, lanes.live, &whole, &sum, &used);
    Indices places = lanes.live ? lanes.row * wide.width + lanes.column : (Indices)-1;
    Index size = plane_size(&wide);
    store_colors(planes, size, divide3(sum.color, sum.weight), places);
    if (RT_HAS(EDGES)) store_in_plane(planes + RT_SIGNATURES * size, used.signature, places);
    // The margin is counted by other tiles, or lies outside the picture.
    Indices column = lanes.column - margin, row = lanes.row - margin;
    Indices inside =
        (column >= 0) & (column < tile->width) & (row >= 0) & (row < tile->height) & lanes.live & 1;
    used.shadow *= inside;
    used.mirror *= inside;
    used.transmitted *= inside;
    count_lanes(&sums, &used);
    return sums;
}

#endif
