// SPDX-License-Identifier: Apache-2.0
//
// The mean of an open pixel in an edges mode (kernels/edges.cl): samples on parallel lines, whose
// segments are cut where that reduces the error most. A segment is the stretch between two samples
// side by side on a line, and its mean is that of its ends. Where their signatures differ, an edge
// lies anywhere in between, so the squared error is a twelfth of the squared change; a cut quarters
// it. So an edge costs as many cuts a line for each digit, where point samples cost a factor.
//
// Each line lies in the middle of a strip, whose mean is that of the line. The error of that shows
// in how the slope from mean to mean changes; where it exceeds that of the segments, strips are
// divided into three. A thin shape slips between the samples of some lines. So the first signature
// seen between two others on a line is noted as rare, and each further line has a sample where its
// neighbors say that the rare surface is.
//
// The first step has four strips from side to side of the pixel, with four samples on each line.
// Every further step has sixteen samples, too: on four lines more, or at sixteen cuts.
#ifndef RT_LINES_CL
#define RT_LINES_CL

#include "kernels/planes.cl"

enum {
    RT_STEP_SAMPLES = 16,
    RT_STEP_LINES = 4,
    RT_LINE_SAMPLES = RT_STEP_SAMPLES / RT_STEP_LINES,
    RT_MOST_LINES = 64,
    RT_MOST_SEGMENTS = 64,  // after a step
    RT_MOST_LINE_SAMPLES = 4096
};

// Squared errors per squared change: of the color along a segment, with an edge or without; of the
// slope between means, where strips are a pixel wide; and of the color from a corner to the line
// next to it, the same. At the sides of a pixel, an edge may end: the squared change of the slope
// is taken as this share of its square, a pixel's width.
#define RT_JUMP_ERROR ((Real)1 / (Real)12)
#define RT_SMOOTH_ERROR ((Real)0.004f)
#define RT_BEND_ERROR ((Real)0.0055f)
#define RT_CORNER_ERROR ((Real)0.02f)
#define RT_SIDE_BEND ((Real)1.5f)

// The squared error, in squared tolerances, at which a pixel is done; and the share of it at which
// a segment is.
#define RT_DONE_ERROR ((Real)26)
#define RT_LEAST_SHARE ((Real)0.004f)

// A sample on a line.
typedef struct {
    Real along, signature;
    Packed3 color;
} Knot;

typedef struct {
    Knot from, to;
    Index line;
} Segment;

typedef struct {
    Real across, width;  // the middle of its strip, and the strip's width
    Packed3 settled;     // the sum over segments that are not kept any more
    Packed3 mean;
    Real low, high;  // the rare signature's first and last place; low > high: not met
} Line;

// An open pixel in the making.
typedef struct {
    Index x, y;
    bool upward;      // lines are upright
    bool is_margin;   // its rays are counted in another tile
    Knot corners[4];  // lower left, lower right, upper left, upper right
    Real cut_off[2];  // squared changes from the first and last line's ends to the corners
    Line lines[RT_MOST_LINES];  // from side to side
    Segment segments[RT_MOST_SEGMENTS];
    Index line_count, segment_count, samples;
    Real rare;                   // a signature; negative: none is known
    Knot step[RT_STEP_SAMPLES];  // the samples to take next
    Index step_lines[RT_STEP_SAMPLES];
    bool cuts;                      // they cut segments,
    Index parts[RT_MOST_SEGMENTS];  // each into so many
} LinePixel;

// Squared errors of the parts of a pixel.
typedef struct {
    Real errors[RT_MOST_SEGMENTS];
    Index count;
    Real sum;
} Errors;

Packed3 packed_black(void) {
    Packed3 black = {(Real)0, (Real)0, (Real)0};
    return black;
}

// a + s b
Packed3 packed_add(Packed3 a, Real s, Packed3 b) {
    Packed3 sum = {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
    return sum;
}

Real clamped_to_unit(Real v) {
    v = v > (Real)0 ? v : (Real)0;
    return v < (Real)1 ? v : (Real)1;
}

Packed3 clamped_difference(Packed3 a, Packed3 b) {
    Packed3 difference = {clamped_to_unit(a.x) - clamped_to_unit(b.x),
                          clamped_to_unit(a.y) - clamped_to_unit(b.y),
                          clamped_to_unit(a.z) - clamped_to_unit(b.z)};
    return difference;
}

// Over channels.
Real mean_square(Packed3 v) { return (v.x * v.x + v.y * v.y + v.z * v.z) * ((Real)1 / (Real)3); }

void start_line(Line* line, Real across, Real width) {
    line->across = across;
    line->width = width;
    line->settled = line->mean = packed_black();
    line->low = (Real)1;
    line->high = (Real)0;
}

bool has_rare(const Line* line) { return line->low <= line->high; }

// The next line in a direction that meets the rare signature; negative: none.
Index next_rare(const LinePixel* pixel, Index line, Index step) {
    do {
        line += step;
    } while (line >= 0 && line < pixel->line_count && !has_rare(&pixel->lines[line]));
    return line < pixel->line_count ? line : -1;
}

Real middle(const Line* line) { return (Real)0.5f * (line->low + line->high); }

// Where a line should meet the rare signature, if between 0 and 1: on the way between the lines on
// both sides that do, or straight on from two on a side.
Real guess_on(const LinePixel* pixel, Index number) {
    Index near = next_rare(pixel, number, -1), far = next_rare(pixel, number, 1);
    if (near < 0) {
        near = far;
        far = near < 0 ? near : next_rare(pixel, near, 1);
    } else if (far < 0) {
        far = next_rare(pixel, near, -1);
    }
    if (near < 0) return (Real)-1;
    const Line* from = &pixel->lines[near];
    if (far < 0) return middle(from);
    const Line* to = &pixel->lines[far];
    Real share = (pixel->lines[number].across - from->across) / (to->across - from->across);
    return middle(from) + share * (middle(to) - middle(from));
}

// Plans the samples of a step's lines: at both ends, and staggered near the thirds.
void plan_samples(LinePixel* pixel, const Index* lines) {
    const Index shifts[RT_STEP_LINES] = {-3, 1, 3, -1};
    pixel->cuts = false;
    for (Index i = 0; i < RT_STEP_LINES; ++i) {
        Real guess = guess_on(pixel, lines[i]);
        if (!(guess > (Real)0 && guess < (Real)1)) guess = (Real)-1;
        for (Index place = 0; place < RT_LINE_SAMPLES; ++place) {
            Index shift = place == 1 || place == 2 ? shifts[i] : 0;
            Real along = (Real)(8 * place + shift) * ((Real)1 / (Real)24);
            if (guess >= (Real)0 && place == (guess < (Real)0.5f ? 1 : 2)) along = guess;
            pixel->step[RT_LINE_SAMPLES * i + place].along = along;
            pixel->step_lines[RT_LINE_SAMPLES * i + place] = lines[i];
        }
    }
}

// The corner whose signature is that of no other; negative: none is.
Index odd_corner(const LinePixel* pixel) {
    Index odd = -1;
    for (Index i = 0; i < 4; ++i) {
        bool alone = true;
        for (Index other = 0; other < 4; ++other) {
            alone &= other == i || pixel->corners[i].signature != pixel->corners[other].signature;
        }
        if (alone) odd = odd < 0 ? i : 4;
    }
    return odd < 4 ? odd : -1;
}

// Strips are narrower towards a corner that is cut off.
void plan_first_lines(LinePixel* pixel) {
    Index lines[RT_STEP_LINES];
    Index odd = odd_corner(pixel);
    Index far = odd < 0 ? 0 : pixel->upward ? odd & 1 : odd >> 1;
    Real from = (Real)0;
    for (Index i = 0; i < RT_STEP_LINES; ++i) {
        Index number = far ? RT_STEP_LINES - i : i + 1;
        Real width = odd < 0 ? (Real)0.25f : (Real)0.1f * (Real)number;
        start_line(&pixel->lines[i], from + (Real)0.5f * width, width);
        from += width;
        lines[i] = i;
    }
    pixel->line_count = RT_STEP_LINES;
    pixel->segment_count = 0;
    pixel->samples = 0;
    pixel->rare = (Real)-1;
    plan_samples(pixel, lines);
}

// Traces the planned samples.
void trace_step(const SceneView* scene, LinePixel* pixel, RayCounts* counts) {
    for (Index first = 0; first < RT_STEP_SAMPLES; first += RT_LANES) {
        RealLanes along, across, signatures, red, green, blue;
        for (Index i = 0; i < RT_LANES; ++i) {
            along.lane[i] = pixel->step[first + i].along;
            across.lane[i] = pixel->lines[pixel->step_lines[first + i]].across;
        }
        Position position = {along.all, across.all};
        if (pixel->upward) {
            position.x = across.all;
            position.y = along.all;
        }
        PacketCounts used = no_counts();
        Ray ray = position_ray(&scene->params, (Indices)pixel->x, (Indices)pixel->y, position);
        real3 color = trace_path(scene, ray, RT_ALL_LANES, &used);
        signatures.all = used.signature;
        red.all = color.x;
        green.all = color.y;
        blue.all = color.z;
        for (Index i = 0; i < RT_LANES; ++i) {
            Packed3 seen = {red.lane[i], green.lane[i], blue.lane[i]};
            pixel->step[first + i].color = seen;
            pixel->step[first + i].signature = signatures.lane[i];
        }
        if (!pixel->is_margin) count_lanes(counts, &used);
    }
    pixel->samples += RT_STEP_SAMPLES;
    if (!pixel->is_margin) counts->primary += RT_STEP_SAMPLES;
}

// Notes the first signature between two others on the lines just traced.
void find_rare(LinePixel* pixel) {
    for (Index i = 0; i < RT_STEP_SAMPLES && pixel->rare < (Real)0; ++i) {
        const Knot* first = &pixel->step[i - i % RT_LINE_SAMPLES];
        Real signature = pixel->step[i].signature;
        bool rare =
            signature != first->signature && signature != first[RT_LINE_SAMPLES - 1].signature;
        if (rare) pixel->rare = signature;
    }
}

// Notes where the samples just traced meet the rare signature.
void note_rare_places(LinePixel* pixel) {
    for (Index i = 0; i < RT_STEP_SAMPLES; ++i) {
        Real along = pixel->step[i].along;
        if (pixel->step[i].signature != pixel->rare) continue;
        Line* line = &pixel->lines[pixel->step_lines[i]];
        if (along < line->low) line->low = along;
        if (along > line->high) line->high = along;
    }
}

// Adds the segments of the lines just traced.
void add_segments(LinePixel* pixel) {
    for (Index i = 0; i < RT_STEP_SAMPLES; ++i) {
        if (i % RT_LINE_SAMPLES == 0) continue;
        Segment* segment = &pixel->segments[pixel->segment_count++];
        segment->from = pixel->step[i - 1];
        segment->to = pixel->step[i];
        segment->line = pixel->step_lines[i];
    }
}

// Cuts segments at the samples just traced; the last part of each keeps its place.
void cut_segments(LinePixel* pixel) {
    Index count = pixel->segment_count, taken = 0;
    for (Index i = 0; i < pixel->segment_count; ++i) {
        Segment* segment = &pixel->segments[i];
        for (Index part = 1; part < pixel->parts[i]; ++part, ++taken) {
            Segment* cut = &pixel->segments[count++];
            cut->from = segment->from;
            cut->to = segment->from = pixel->step[taken];
            cut->line = segment->line;
        }
    }
    pixel->segment_count = count;
}

Packed3 with_segment(Packed3 sum, const Segment* segment) {
    Real half_length = (Real)0.5f * (segment->to.along - segment->from.along);
    sum = packed_add(sum, half_length, segment->from.color);
    return packed_add(sum, half_length, segment->to.color);
}

// The errors of the segments that are kept, and the means of the lines. Those of at most this
// error, or of a few times it where there are too many for a further step, are settled.
void rate_segments(LinePixel* pixel, Real least, Errors* rated) {
    do {
        rated->count = 0;
        rated->sum = (Real)0;
        for (Index i = 0; i < pixel->segment_count; ++i) {
            const Segment* segment = &pixel->segments[i];
            Line* line = &pixel->lines[segment->line];
            Real area = (segment->to.along - segment->from.along) * line->width;
            Packed3 change = clamped_difference(segment->to.color, segment->from.color);
            bool jumps = segment->from.signature != segment->to.signature;
            Real error =
                mean_square(change) * area * area * (jumps ? RT_JUMP_ERROR : RT_SMOOTH_ERROR);
            if (!(error > least)) {
                line->settled = with_segment(line->settled, segment);
                continue;
            }
            if (i != rated->count) pixel->segments[rated->count] = *segment;
            rated->errors[rated->count++] = error;
            rated->sum += error;
        }
        pixel->segment_count = rated->count;
        least *= (Real)4;
    } while (rated->count > RT_MOST_SEGMENTS - RT_STEP_SAMPLES);
    for (Index i = 0; i < pixel->line_count; ++i) pixel->lines[i].mean = pixel->lines[i].settled;
    for (Index i = 0; i < rated->count; ++i) {
        Line* line = &pixel->lines[pixel->segments[i].line];
        line->mean = with_segment(line->mean, &pixel->segments[i]);
    }
}

// The change from line to line in a mean, per distance.
Packed3 slope_between(const Line* before, const Line* after) {
    Packed3 slope = clamped_difference(after->mean, before->mean);
    return packed_add(packed_black(), (Real)1 / (after->across - before->across), slope);
}

// The squared change of this slope at a line; at a side, what it may be.
Real bend_at(const LinePixel* pixel, Index line) {
    const Line* here = &pixel->lines[line];
    if (line == 0 || line == pixel->line_count - 1) {
        const Line* first = line == 0 ? here : here - 1;
        return RT_SIDE_BEND * here->width * mean_square(slope_between(first, first + 1));
    }
    return mean_square(
        packed_add(slope_between(here, here + 1), (Real)-1, slope_between(here - 1, here)));
}

// The errors of lines as means of their strips.
void rate_strips(const LinePixel* pixel, Errors* rated) {
    rated->count = pixel->line_count;
    rated->sum = (Real)0;
    for (Index i = 0; i < rated->count; ++i) {
        Real width = pixel->lines[i].width;
        Real squared = width * width;
        rated->errors[i] = RT_BEND_ERROR * squared * squared * bend_at(pixel, i);
        Real cut_off = (i == 0 ? pixel->cut_off[0] : (Real)0) +
                       (i == rated->count - 1 ? pixel->cut_off[1] : (Real)0);
        rated->errors[i] += RT_CORNER_ERROR * squared * cut_off;
        rated->sum += rated->errors[i];
    }
}

// Shares out parts: each goes to the worst error, which is then divided by the square of its parts.
void deal_parts(const Errors* rated, Index more, Index* parts) {
    Real left[RT_MOST_SEGMENTS];
    for (Index i = 0; i < rated->count; ++i) {
        parts[i] = 1;
        left[i] = rated->errors[i];
    }
    for (; more > 0; --more) {
        Index worst = 0;
        for (Index i = 1; i < rated->count; ++i) worst = left[i] > left[worst] ? i : worst;
        parts[worst] += 1;
        left[worst] = rated->errors[worst] / (Real)(parts[worst] * parts[worst]);
    }
}

// The number of the largest error.
Index worst_of(const Errors* rated) {
    Index worst = 0;
    for (Index i = 1; i < rated->count; ++i) {
        worst = rated->errors[i] > rated->errors[worst] ? i : worst;
    }
    return worst;
}

// Plans a line on each side of the two worst.
void plan_more_lines(LinePixel* pixel, Errors* strips) {
    Line* lines = pixel->lines;
    Index moved[RT_MOST_LINES], added[RT_STEP_LINES];
    Index first = worst_of(strips);
    strips->errors[first] = (Real)-1;
    Index second = worst_of(strips);
    Index place = pixel->line_count + RT_STEP_LINES, count = 0;
    for (Index i = pixel->line_count - 1; i >= 0; --i) {
        Line line = lines[i];
        bool splits = i == first || i == second;
        if (splits) {
            line.width *= (Real)1 / (Real)3;
            start_line(&lines[--place], line.across + line.width, line.width);
            added[count++] = place;
        }
        lines[--place] = line;
        moved[i] = place;
        if (splits) {
            start_line(&lines[--place], line.across - line.width, line.width);
            added[count++] = place;
        }
    }
    pixel->line_count += RT_STEP_LINES;
    for (Index i = 0; i < pixel->segment_count; ++i) {
        pixel->segments[i].line = moved[pixel->segments[i].line];
    }
    plan_samples(pixel, added);
}

// Plans cuts of the worst segments.
void plan_cuts(LinePixel* pixel, const Errors* rated) {
    pixel->cuts = true;
    deal_parts(rated, RT_STEP_SAMPLES, pixel->parts);
    Index count = 0;
    for (Index i = 0; i < rated->count; ++i) {
        const Segment* segment = &pixel->segments[i];
        Real length = segment->to.along - segment->from.along;
        for (Index part = 1; part < pixel->parts[i]; ++part) {
            Real share = (Real)part / (Real)pixel->parts[i];
            pixel->step[count].along = segment->from.along + share * length;
            pixel->step_lines[count++] = segment->line;
        }
    }
}

// Notes where the corners differ from the ends of the lines next to them, if those are new.
void compare_corners(LinePixel* pixel) {
    for (Index side = 0; side < 2; ++side) {
        Index line = side == 0 ? 0 : pixel->line_count - 1;
        for (Index i = 0; i < RT_STEP_SAMPLES; ++i) {
            const Knot* knot = &pixel->step[i];
            if (pixel->step_lines[i] != line || i % RT_LINE_SAMPLES != 0) continue;
            pixel->cut_off[side] = (Real)0;
            for (Index end = 0; end < 2; ++end) {
                const Knot* from = end == 0 ? knot : knot + RT_LINE_SAMPLES - 1;
                const Knot* to = &pixel->corners[pixel->upward ? side + 2 * end : end + 2 * side];
                Real change = mean_square(clamped_difference(from->color, to->color));
                if (from->signature != to->signature && change > pixel->cut_off[side]) {
                    pixel->cut_off[side] = change;
                }
            }
        }
    }
}

// Takes in the samples just traced.
void take_step(LinePixel* pixel) {
    if (pixel->cuts) {
        cut_segments(pixel);
    } else {
        find_rare(pixel);
        compare_corners(pixel);
        add_segments(pixel);
    }
    note_rare_places(pixel);
}

// Takes in the samples of a step and plans the next. False when the pixel is done: its squared
// error is small enough, or not a number.
bool plan_step(LinePixel* pixel, Real tolerance) {
    take_step(pixel);
    Real done = RT_DONE_ERROR * tolerance * tolerance;
    Errors rated, strips;
    rate_segments(pixel, RT_LEAST_SHARE * done, &rated);
    rate_strips(pixel, &strips);
    if (pixel->line_count + RT_STEP_LINES > RT_MOST_LINES) strips.sum = (Real)0;
    if (!(rated.sum + strips.sum > done)) return false;
    if (pixel->samples >= RT_MOST_LINE_SAMPLES) return false;
    if (strips.sum > rated.sum) {
        plan_more_lines(pixel, &strips);
    } else {
        plan_cuts(pixel, &rated);
    }
    return true;
}

Packed3 mean_of_lines(const LinePixel* pixel) {
    Packed3 mean = packed_black();
    for (Index i = 0; i < pixel->line_count; ++i) {
        mean = packed_add(mean, pixel->lines[i].width, pixel->lines[i].mean);
    }
    return mean;
}

#endif
