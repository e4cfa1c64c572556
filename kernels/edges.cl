// SPDX-License-Identifier: Apache-2.0
//
// An edges mode: one sample at each pixel's center, with its signature. Where a pixel and its eight
// neighbors have the same signature, and no contrast beyond the tolerance, its
// mean is that of the parabola through five of them. Any other pixel is open: it gets Owen-Sobol
// samples, doubled as long as that pays (edges_item). A thin shape can pass between centers, so
// where an open pixel's samples meet something new next to a side, the pixel behind that side is
// opened, too, in two further rounds.
//
// Tiles bring along the first samples of open pixels two pixels around them (kernels/planes.cl).
#ifndef RT_EDGES_CL
#define RT_EDGES_CL

#include "kernels/planes.cl"

// An open pixel's first samples, and its last.
#define RT_EDGE_SAMPLES 16
#define RT_MOST_EDGE_SAMPLES 4096

// The error of n samples at an edge is about 0.7 sigma n^-0.75.
#define RT_EDGE_ERROR 0.49f  // 0.7^2

// The variance of what an open pixel's samples may have missed, as a share of the squared contrast
// to its neighbors: at an edge, and elsewhere. It counts as much as one sample.
#define RT_UNSEEN_EDGE 0.15f
#define RT_UNSEEN_DETAIL 0.05f

// An edge is worth the first samples if its squared contrast exceeds this many squared tolerances.
#define RT_LEAST_CONTRAST 32

// An open pixel's state, and the sides next to which its samples meet something new.
enum { RT_LEFT = 1, RT_RIGHT = 2, RT_BELOW = 4, RT_ABOVE = 8, RT_OPEN = 16 };

// Planes beyond those of kernels/planes.cl: the states that each round but the last leaves.
enum { RT_STATES = RT_SIGNATURES + 1 };

// The mean over channels of the squared difference.
Reals squared_difference(real3 a, real3 b) {
    real3 difference = sub3(clamped3(a), clamped3(b));
    return dot3(difference, difference) * (Reals)((Real)1 / (Real)3);
}

Real first_lane(Reals v) {
    RealLanes lanes;
    lanes.all = v;
    return lanes.lane[0];
}

// Pixels that are looked at in one round: the open ones, all signatures, and the variances that
// samples may not show.
typedef struct {
    Mask open;
    Reals signature, unseen;
    real3 mean;  // of pixels that are not open
} EdgePacket;

// The first round.
EdgePacket find_edges(__global const Real* planes, Index size, Index across, Index at,
                      Real tolerance) {
    real3 own = load_colors(planes, size, at);
    EdgePacket found;
    found.signature = load_row(planes + RT_SIGNATURES * size + at);
    Mask same = RT_ALL_LANES;
    Reals contrast = (Reals)0;
    real3 sides = make3((Reals)0, (Reals)0, (Reals)0);
    for (Index dy = -1; dy <= 1; ++dy) {
        for (Index dx = -1; dx <= 1; ++dx) {
            if (dx == 0 && dy == 0) continue;
            Index there = at + dy * across + dx;
            real3 color = load_colors(planes, size, there);
            same &= load_row(planes + RT_SIGNATURES * size + there) == found.signature;
            contrast = max_of(contrast, squared_difference(color, own));
            if (dx == 0 || dy == 0) sides = add3(sides, color);
        }
    }
    // The value and its Laplacian / 24.
    found.mean =
        add_scaled(scale3((Reals)((Real)5 / (Real)6), own), (Reals)((Real)1 / (Real)24), sides);
    // Not clamped: the mean of an overexposed pixel is stored, too. NaNs open a pixel.
    real3 change = sub3(found.mean, own);
    Reals squared = (Reals)(tolerance * tolerance);
    Mask settled = same | (contrast <= (Reals)RT_LEAST_CONTRAST * squared);
    found.open = !(settled & (dot3(change, change) <= (Reals)12 * squared));
    found.unseen = contrast * (same ? (Reals)RT_UNSEEN_DETAIL : (Reals)RT_UNSEEN_EDGE);
    return found;
}

Mask asks(__global const Real* states, Index at, Index side) {
    return (Mask)((RT_TO_INDICES(load_row(states + at)) & side) != 0);
}

// A further round: pixels that are not open yet and lie behind sides noted in the last one.
EdgePacket follow_edges(__global const Real* planes, Index size, Index across, Index at,
                        Index round) {
    EdgePacket found;
    found.signature = load_row(planes + RT_SIGNATURES * size + at);
    found.unseen = (Reals)0;
    __global const Real* states = planes + (RT_STATES + round - 1) * size;
    found.open = asks(states, at - 1, RT_RIGHT) | asks(states, at + 1, RT_LEFT) |
                 asks(states, at - across, RT_BELOW) | asks(states, at + across, RT_ABOVE);
    for (Index before = 0; before < round; ++before) {
        found.open &= !asks(planes + (RT_STATES + before) * size, at, RT_OPEN);
    }
    return found;
}

// The sides next to which one of these samples has another signature.
Index noted_sides(const LaunchParams* params, Indices x, Indices y, Indices k, Mask foreign) {
    if (!any_lane(foreign)) return 0;
    Position position = sample_position(params, x, y, k);
    Mask left = position.x < (Reals)0.5f, below = position.y < (Reals)0.5f;
    return (any_lane(foreign & left) ? RT_LEFT : 0) | (any_lane(foreign & !left) ? RT_RIGHT : 0) |
           (any_lane(foreign & below) ? RT_BELOW : 0) | (any_lane(foreign & !below) ? RT_ABOVE : 0);
}

// An open pixel in the making.
typedef struct {
    real3 color;  // in the first lane
    Index state;
    Index samples;
} EdgePixel;

// Pixel (x, y) with as many samples as pay: twice as many would reduce the picture's error by less
// than the tolerance asks for. With its first samples alone if it lies in the margin.
EdgePixel trace_edge_pixel(const SceneView* scene, Index x, Index y, Real signature, Real unseen,
                           bool is_margin, RayCounts* counts) {
    Packet packet = make_packet(RT_EDGE_SAMPLES, RT_LANES);
    Sum sum = empty_sum(), whole = sum;
    real3 moment = make3((Reals)0, (Reals)0, (Reals)0);  // of clamped colors
    Reals square = (Reals)0;
    Real tolerance = scene->params.tolerance;
    Real limit = tolerance * tolerance * (Real)256;  // T^2 n^2.5 / 4
    EdgePixel pixel = {moment, RT_OPEN, 0};
    for (Index n = RT_EDGE_SAMPLES;; n *= 2) {
        for (; pixel.samples < n; pixel.samples += packet.samples) {
            PacketCounts used = no_counts();
            real3 color = add_packet(scene, &packet, (Indices)x, (Indices)y, pixel.samples,
                                     RT_ALL_LANES, &whole, &sum, &used);
            if (pixel.samples < RT_EDGE_SAMPLES) {
                pixel.state |=
                    noted_sides(&scene->params, (Indices)x, (Indices)y,
                                pixel.samples + packet.sample, used.signature != (Reals)signature);
            }
            real3 seen = clamped3(color);
            moment.x = add_samples(moment.x, (Reals)1, seen.x, packet.samples);
            moment.y = add_samples(moment.y, (Reals)1, seen.y, packet.samples);
            moment.z = add_samples(moment.z, (Reals)1, seen.z, packet.samples);
            square = add_samples(square, (Reals)1, dot3(seen, seen), packet.samples);
            if (!is_margin) count_lanes(counts, &used);
        }
        Reals share = (Reals)((Real)1 / (Real)n);
        real3 mean = scale3(share, moment);
        Real variance = first_lane(square * share - dot3(mean, mean)) * ((Real)1 / (Real)3);
        variance = (variance > (Real)0 ? variance : (Real)0) + unseen / (Real)n;
        if (is_margin || !((Real)RT_EDGE_ERROR * variance > limit)) break;
        if (n == RT_MOST_EDGE_SAMPLES) break;
        limit *= (Real)5.656854f;  // 2^2.5
    }
    whole = add_sums(whole, sum);
    pixel.color = divide3(whole.color, whole.weight);
    return pixel;
}

// Traces an open pixel, column and row from the tile's upper left one, and stores its color if it
// is the tile's. Returns its state.
Index trace_open_pixel(__global Real* film, const SceneView* scene, const Tile* tile, Index column,
                       Index row, Real signature, Real unseen, RayCounts* counts) {
    bool is_margin = column < 0 || column >= tile->width || row < 0 || row >= tile->height;
    EdgePixel pixel =
        trace_edge_pixel(scene, tile->x + column, scene->params.height - 1 - tile->y - row,
                         signature, unseen, is_margin, counts);
    if (is_margin) return pixel.state;
    counts->primary += (RT_COUNT)pixel.samples;
    store3(film, tile->first + row * tile->film_width + column, first_lane(pixel.color.x),
           first_lane(pixel.color.y), first_lane(pixel.color.z));
    return pixel.state;
}

// One round over a packet of pixels side by side.
RayCounts edges_item(__global Real* film, __global Real* planes, SceneView* scene, const Tile* tile,
                     Index round, Index item) {
    RayCounts sums = {0, 0, 0, 0};
    Index margin = RT_EDGE_MARGIN - 1 - round;
    RowPacket packet = row_packet(&scene->params, tile, margin, item);
    Index row = packet.row, column = packet.column, end = packet.end;
    if (row >= tile->height + margin || tile->height == 0) return sums;
    Index size = packet.size, at = packet.at, across = packet.wide.width;
    EdgePacket found = round == 0 ? find_edges(planes, size, across, at, scene->params.tolerance)
                                  : follow_edges(planes, size, across, at, round);
    Indices columns = column + RT_LANE_NUMBERS;
    if (round == 0 && packet.is_in_tile) {
        Mask settled = !found.open & (columns >= 0) & (columns < tile->width);
        Indices places = tile->first + row * tile->film_width + columns;
        store_lanes(film, found.mean, settled ? places : (Indices)-1, RT_LANES);
    }
    RealLanes signature, unseen;
    IndexLanes open;
    signature.all = found.signature;
    unseen.all = found.unseen;
    open.all = found.open & (columns < end) & 1;
    scene->params.sampling = RT_SAMPLES_SOBOL;
    for (Index i = 0; i < RT_LANES && column + i < end; ++i) {
        Index state = 0;
        if (open.lane[i] != 0) {
            state = trace_open_pixel(film, scene, tile, column + i, row, signature.lane[i],
                                     unseen.lane[i], &sums);
        }
        if (margin > 0) planes[(RT_STATES + round) * size + at + i] = (Real)state;
    }
    scene->params.sampling = RT_SAMPLES_GRID;
    return sums;
}

#endif
