// SPDX-License-Identifier: Apache-2.0
//
// An edges mode: one sample at each pixel's lower left corner, with its signature. Where a pixel's
// four corners and the eight next to them have the same signature, or no contrast beyond the
// tolerance, its mean is that of the four, less a twelfth of the Laplacian. Any other pixel is
// open: it gets samples on lines, as long as that pays (kernels/lines.cl). A thin shape can pass
// between corners, so where an open pixel's first samples meet something new, the pixels behind the
// sides next to it are opened, too, in three further rounds.
//
// Tiles bring along the first samples of open pixels three pixels around them (kernels/planes.cl).
#ifndef RT_EDGES_CL
#define RT_EDGES_CL

#include "kernels/lines.cl"

// An edge is worth the first samples if its squared contrast exceeds this many squared tolerances;
// shades next to an edge, if theirs exceeds three times as many.
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

// The place of a corner of the pixel at `at`: lower left, lower right, upper left, upper right.
Index corner_at(Index at, Index across, Index corner) {
    return at + (corner & 1) - (corner >> 1) * across;
}

// The second difference of three colors in a row where all have the same signature, else 0. Adds to
// `count` where they do.
real3 bend_of(__global const Real* planes, Index size, Index at, Index step, Mask same, Reals own,
              real3 near, real3 far, Reals* count) {
    Mask known = same & (load_row(planes + RT_SIGNATURES * size + at - step) == own);
    real3 outer = load_colors(planes, size, at - step);
    real3 bend = add_scaled(add3(outer, far), (Reals)-2, near);
    *count += known ? (Reals)1 : (Reals)0;
    return select3(known, bend, sub3(near, near));
}

// The first round: the pixels to open, and the mean of the others.
Mask find_edges(__global const Real* planes, Index size, Index across, Index at, Real tolerance,
                real3* mean) {
    Reals own = load_row(planes + RT_SIGNATURES * size + at);
    Mask same = RT_ALL_LANES;
    real3 sum = make3((Reals)0, (Reals)0, (Reals)0), laplacian = sum, colors[4];
    for (Index i = 0; i < 4; ++i) {
        Index place = corner_at(at, across, i);
        same &= load_row(planes + RT_SIGNATURES * size + place) == own;
        colors[i] = load_colors(planes, size, place);
        sum = add3(sum, colors[i]);
    }
    Reals contrast = (Reals)0, known = (Reals)0;
    for (Index axis = 1; axis <= 2; ++axis) {
        Index step = axis == 1 ? 1 : -across;
        Reals count = (Reals)0;
        real3 bend = make3((Reals)0, (Reals)0, (Reals)0);
        for (Index i = 0; i < 4; ++i) {
            real3 near = colors[i], far = colors[i ^ axis];
            contrast = max_of(contrast, squared_difference(near, far));
            bend = add3(bend, bend_of(planes, size, corner_at(at, across, i),
                                      (i & axis) ? -step : step, same, own, near, far, &count));
        }
        known += count;
        laplacian = add_scaled(laplacian, (Reals)1 / max_of(count, (Reals)1), bend);
    }
    real3 change = scale3((Reals)((Real)1 / (Real)12), laplacian);
    *mean = sub3(scale3((Reals)(Real)0.25f, sum), change);
    // Not clamped: the mean of an overexposed pixel is stored, too. NaNs open a pixel.
    Reals squared = (Reals)(tolerance * tolerance);
    Reals least = (Reals)RT_LEAST_CONTRAST * squared;
    Mask settled = (known == (Reals)8) | (contrast <= (same ? (Reals)3 * least : least));
    return !(settled & (dot3(change, change) <= (Reals)48 * squared));
}

Mask asks(__global const Real* states, Index at, Index side) {
    return (Mask)((RT_TO_INDICES(load_row(states + at)) & side) != 0);
}

// A further round: pixels that are not open yet and lie behind sides noted in the last one.
Mask follow_edges(__global const Real* planes, Index size, Index across, Index at, Index round) {
    __global const Real* states = planes + (RT_STATES + round - 1) * size;
    Mask open = asks(states, at - 1, RT_RIGHT) | asks(states, at + 1, RT_LEFT) |
                asks(states, at - across, RT_BELOW) | asks(states, at + across, RT_ABOVE);
    for (Index before = 0; before < round; ++before) {
        open &= !asks(planes + (RT_STATES + before) * size, at, RT_OPEN);
    }
    return open;
}

// Where corners differ more from those above or below than from those to the left or right.
Mask differ_upward(__global const Real* planes, Index size, Index across, Index at) {
    real3 colors[4];
    for (Index i = 0; i < 4; ++i) colors[i] = load_colors(planes, size, corner_at(at, across, i));
    Reals along_x =
        squared_difference(colors[0], colors[1]) + squared_difference(colors[2], colors[3]);
    Reals along_y =
        squared_difference(colors[0], colors[2]) + squared_difference(colors[1], colors[3]);
    return along_y > along_x;
}

// The sides behind which there may be more of what one of a pixel's first samples meets: those next
// to it if no corner meets that, or those at which it lies if neither of their corners does.
Index noted_sides(const LinePixel* pixel) {
    const Knot* corners = pixel->corners;
    Index sides = 0;
    for (Index i = 0; i < RT_STEP_SAMPLES; ++i) {
        const Knot* knot = &pixel->step[i];
        Index line = pixel->step_lines[i];
        bool first = knot->along < (Real)0.5f, low = line < RT_STEP_LINES / 2;
        bool left = pixel->upward ? low : first, below = pixel->upward ? first : low;
        bool ends = knot->along == (Real)0 || knot->along == (Real)1;
        bool outer = line == 0 || line == RT_STEP_LINES - 1;
        Index column = left ? 0 : 1, row = below ? 0 : 2;
        bool new_x = knot->signature != corners[column].signature &&
                     knot->signature != corners[column + 2].signature;
        bool new_y = knot->signature != corners[row].signature &&
                     knot->signature != corners[row + 1].signature;
        bool is_new = new_x && knot->signature != corners[1 - column].signature &&
                      knot->signature != corners[3 - column].signature;
        if (is_new || (new_x && (pixel->upward ? outer : ends))) {
            sides |= left ? RT_LEFT : RT_RIGHT;
        }
        if (is_new || (new_y && (pixel->upward ? ends : outer))) {
            sides |= below ? RT_BELOW : RT_ABOVE;
        }
    }
    return sides;
}

// Traces an open pixel, column and row from the tile's upper left one, and stores its color if it
// is the tile's; with its first samples alone if it lies in the margin. Returns its state.
Index trace_open_pixel(__global Real* film, const SceneView* scene, const Tile* tile, Index column,
                       Index row, const Knot* corners, bool upward, RayCounts* counts) {
    LinePixel pixel;
    pixel.x = tile->x + column;
    pixel.y = scene->params.height - 1 - tile->y - row;
    pixel.upward = upward;
    for (Index i = 0; i < 4; ++i) pixel.corners[i] = corners[i];
    pixel.is_margin = column < 0 || column >= tile->width || row < 0 || row >= tile->height;
    plan_first_lines(&pixel);
    Index state = 0;
    do {
        trace_step(scene, &pixel, counts);
        if (state == 0) state = RT_OPEN | noted_sides(&pixel);
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
    Index margin = RT_EDGE_ROUNDS - 1 - round;
    RowPacket packet = row_packet(&scene->params, tile, margin, item);
    Index row = packet.row, column = packet.column, end = packet.end;
    if (row >= tile->height + margin || tile->height == 0) return sums;
    Index size = packet.size, at = packet.at, across = packet.wide.width;
    Indices columns = column + RT_LANE_NUMBERS;
    Mask open;
    if (round == 0) {
        real3 mean;
        open = find_edges(planes, size, across, at, scene->params.tolerance, &mean);
        Mask settled = !open & (columns >= 0) & (columns < tile->width);
        Indices places = tile->first + row * tile->film_width + columns;
        if (packet.is_in_tile) store_lanes(film, mean, settled ? places : (Indices)-1, RT_LANES);
    } else {
        open = follow_edges(planes, size, across, at, round);
    }
    open &= (Mask)(columns < end);
    __global Real* states = planes + (RT_STATES + round) * size + at;
    for (Index i = 0; margin > 0 && i < RT_LANES && column + i < end; ++i) states[i] = (Real)0;
    if (!any_lane(open)) return sums;
    IndexLanes is_open, upward;
    is_open.all = open & 1;
    upward.all = differ_upward(planes, size, across, at);
    for (Index i = 0; i < RT_LANES; ++i) {
        if (is_open.lane[i] == 0) continue;
        Knot own[4];
        for (Index c = 0; c < 4; ++c) {
            Index place = corner_at(at + i, across, c);
            own[c].signature = planes[RT_SIGNATURES * size + place];
            own[c].color.x = planes[place];
            own[c].color.y = planes[size + place];
            own[c].color.z = planes[2 * size + place];
        }
        Index state =
            trace_open_pixel(film, scene, tile, column + i, row, own, upward.lane[i] != 0, &sums);
        if (margin > 0) states[i] = (Real)state;
    }
    return sums;
}

#endif
