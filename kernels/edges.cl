// SPDX-License-Identifier: Apache-2.0
//
// An edges mode: one sample at each pixel's center, with its signature. Where a pixel and the four
// next to it have the same signature, and no contrast beyond the tolerance, its mean is that of the
// parabola through these five. Any other pixel is open: it gets samples on lines, as long as that
// pays (kernels/lines.cl). A thin shape can pass between centers, so where an open pixel's first
// samples meet something new next to a side, the pixel behind that side is opened, too, in two
// further rounds.
//
// Tiles bring along the first samples of open pixels two pixels around them (kernels/planes.cl).
#ifndef RT_EDGES_CL
#define RT_EDGES_CL

#include "kernels/lines.cl"

// An edge is worth the first samples if its squared contrast exceeds this many squared tolerances.
#define RT_LEAST_CONTRAST 200

// An open pixel's state, and the sides next to which its samples meet something new.
enum { RT_LEFT = 1, RT_RIGHT = 2, RT_BELOW = 4, RT_ABOVE = 8, RT_OPEN = 16 };

// Planes beyond those of kernels/planes.cl: the states that each round but the last leaves.
enum { RT_STATES = RT_SIGNATURES + 1 };

// The mean over channels of the squared difference.
Reals squared_difference(real3 a, real3 b) {
    real3 difference = sub3(clamped3(a), clamped3(b));
    return dot3(difference, difference) * (Reals)((Real)1 / (Real)3);
}

// Pixels that are looked at in one round.
typedef struct {
    Mask open;
    Reals signature;
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
    const Index steps[4] = {-1, 1, -across, across};
    for (Index i = 0; i < 4; ++i) {
        real3 color = load_colors(planes, size, at + steps[i]);
        same &= load_row(planes + RT_SIGNATURES * size + at + steps[i]) == found.signature;
        contrast = max_of(contrast, squared_difference(color, own));
        sides = add3(sides, color);
    }
    // The value and its Laplacian / 24.
    found.mean =
        add_scaled(scale3((Reals)((Real)5 / (Real)6), own), (Reals)((Real)1 / (Real)24), sides);
    // Not clamped: the mean of an overexposed pixel is stored, too. NaNs open a pixel.
    real3 change = sub3(found.mean, own);
    Reals squared = (Reals)(tolerance * tolerance);
    Mask settled = same | (contrast <= (Reals)RT_LEAST_CONTRAST * squared);
    found.open = !(settled & (dot3(change, change) <= (Reals)12 * squared));
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
    __global const Real* states = planes + (RT_STATES + round - 1) * size;
    found.open = asks(states, at - 1, RT_RIGHT) | asks(states, at + 1, RT_LEFT) |
                 asks(states, at - across, RT_BELOW) | asks(states, at + across, RT_ABOVE);
    for (Index before = 0; before < round; ++before) {
        found.open &= !asks(planes + (RT_STATES + before) * size, at, RT_OPEN);
    }
    return found;
}

// Where centers differ more from those above and below than from those to the left and right.
Mask differ_upward(__global const Real* planes, Index size, Index across, Index at) {
    real3 own = load_colors(planes, size, at);
    Reals along_x = squared_difference(load_colors(planes, size, at - 1), own) +
                    squared_difference(load_colors(planes, size, at + 1), own);
    Reals along_y = squared_difference(load_colors(planes, size, at - across), own) +
                    squared_difference(load_colors(planes, size, at + across), own);
    return along_y > along_x;
}

// The sides next to which one of a pixel's first samples has another signature.
Index noted_sides(const LinePixel* pixel, Real signature) {
    Index sides = 0;
    for (Index i = 0; i < RT_STEP_SAMPLES; ++i) {
        if (pixel->step[i].signature == signature) continue;
        bool first = pixel->step[i].along < (Real)0.5f;
        bool low = pixel->lines[pixel->step_lines[i]].across < (Real)0.5f;
        bool left = pixel->upward ? low : first, below = pixel->upward ? first : low;
        sides |= (left ? RT_LEFT : RT_RIGHT) | (below ? RT_BELOW : RT_ABOVE);
    }
    return sides;
}

// Traces an open pixel, column and row from the tile's upper left one, and stores its color if it
// is the tile's; with its first samples alone if it lies in the margin. Returns its state.
Index trace_open_pixel(__global Real* film, const SceneView* scene, const Tile* tile, Index column,
                       Index row, Real signature, bool upward, RayCounts* counts) {
    LinePixel pixel;
    pixel.x = tile->x + column;
    pixel.y = scene->params.height - 1 - tile->y - row;
    pixel.upward = upward;
    pixel.is_margin = column < 0 || column >= tile->width || row < 0 || row >= tile->height;
    plan_first_lines(&pixel);
    Index state = 0;
    do {
        trace_step(scene, &pixel, counts);
        if (state == 0) state = RT_OPEN | noted_sides(&pixel, signature);
    } while (!pixel.is_margin && plan_step(&pixel, scene->params.tolerance));
    if (pixel.is_margin) return state;
    Packed3 mean = mean_of_lines(&pixel);
    store3(film, tile->first + row * tile->film_width + column, mean.x, mean.y, mean.z);
    return state;
}

// One round over a packet of pixels side by side.
RayCounts edges_item(__global Real* film, __global Real* planes, const SceneView* scene,
                     const Tile* tile, Index round, Index item) {
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
    RealLanes signature;
    IndexLanes open, upward;
    signature.all = found.signature;
    open.all = found.open & (columns < end) & 1;
    upward.all = differ_upward(planes, size, across, at);
    for (Index i = 0; i < RT_LANES && column + i < end; ++i) {
        Index state = 0;
        if (open.lane[i] != 0) {
            state = trace_open_pixel(film, scene, tile, column + i, row, signature.lane[i],
                                     upward.lane[i] != 0, &sums);
        }
        if (margin > 0) planes[(RT_STATES + round) * size + at + i] = (Real)state;
    }
    return sums;
}

#endif
