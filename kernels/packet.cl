// SPDX-License-Identifier: Apache-2.0
//
// How the lanes of a packet divide up pixels and samples: four samples of each pixel if their
// number allows, else two, else one, with the pixels in a block as square as possible, so that the
// rays stay close together. Chosen pixels may be far apart, so there a packet holds as many samples
// of a pixel as it can. A pixel's samples are added in order, whatever the packet, so the sums have
// the same bits.
#ifndef RT_PACKET_CL
#define RT_PACKET_CL

#include "kernels/whitted.cl"

#define RT_LOG_LANES ((RT_LANES > 1) + (RT_LANES > 2) + (RT_LANES > 4) + (RT_LANES > 8))

typedef struct {
    Index samples;  // of each pixel
    Index pixels;   // in a block of width x height
    Index width, height;
    Index log_width;
    Indices pixel, sample;  // per lane, counted from the packet's first; pixels row by row
} Packet;

// For pixels with `samples` samples each, of which a packet holds at most most_samples.
Packet make_packet(Index samples, Index most_samples) {
    Index log_samples = 0;
    Index together = 2;
    while (together <= most_samples && log_samples < RT_LOG_LANES && samples % together == 0) {
        together *= 2;
        log_samples += 1;
    }
    Index log_pixels = RT_LOG_LANES - log_samples;
    Index log_width = (log_pixels + 1) / 2;
    Packet packet;
    packet.samples = (Index)1 << log_samples;
    packet.pixels = (Index)1 << log_pixels;
    packet.log_width = log_width;
    packet.width = (Index)1 << log_width;
    packet.height = (Index)1 << (log_pixels - log_width);
    packet.pixel = RT_LANE_NUMBERS & (packet.pixels - 1);
    packet.sample = RT_LANE_NUMBERS >> log_pixels;
    return packet;
}

// sum + weight x v over a pixel's samples in order; valid only in the first lanes, those of the
// first sample.
Reals add_samples(Reals sum, Reals weight, Reals v, Index samples) {
#if RT_LANES >= 4
    if (samples == 4) {
        Reals quarter;
        quarter.lo.lo = fma(weight.lo.lo, v.lo.lo, sum.lo.lo);
        quarter.lo.lo = fma(weight.lo.hi, v.lo.hi, quarter.lo.lo);
        quarter.lo.lo = fma(weight.hi.lo, v.hi.lo, quarter.lo.lo);
        quarter.lo.lo = fma(weight.hi.hi, v.hi.hi, quarter.lo.lo);
        return quarter;
    }
#endif
#if RT_LANES >= 2
    if (samples == 2) {
        Reals half_sum;
        half_sum.lo = fma(weight.lo, v.lo, sum.lo);
        half_sum.lo = fma(weight.hi, v.hi, half_sum.lo);
        return half_sum;
    }
#endif
#if RT_LANES >= 8
    if (samples > 4) {
        RealLanes weights, values, sums;
        weights.all = weight;
        values.all = v;
        sums.all = sum;
        Index pixels = RT_LANES / samples;
        for (Index lane = 0; lane < RT_LANES; ++lane) {
            Index pixel = lane & (pixels - 1);
            sums.lane[pixel] = fma(weights.lane[lane], values.lane[lane], sums.lane[pixel]);
        }
        return sums.all;
    }
#endif
    return fma(weight, v, sum);
}

// sum / total; valid only in the first lanes, one per pixel.
Reals average(Reals sum, Reals total, Index samples) {
#if RT_LANES >= 4
    if (samples == 4) {
        Reals quarter;
        quarter.lo.lo = sum.lo.lo / total.lo.lo;
        return quarter;
    }
#endif
    return sum / total;
}

void count_lanes(RayCounts* counts, const PacketCounts* used) {
    counts->shadow += (RT_COUNT)sum_lanes(used->shadow);
    counts->mirror += (RT_COUNT)sum_lanes(used->mirror);
    counts->transmitted += (RT_COUNT)sum_lanes(used->transmitted);
}

// A pixel's weighted colors and its weights, added up. In one sum of thousands, equal samples would
// all be rounded the same way and lose ten bits, so sums of RT_PARTIAL_SUM samples are added.
#define RT_PARTIAL_SUM 256

typedef struct {
    real3 color;
    Reals weight;
} Sum;

Sum empty_sum(void) {
    Sum sum = {make3((Reals)0, (Reals)0, (Reals)0), (Reals)0};
    return sum;
}

Sum add_sums(Sum a, Sum b) {
    Sum sum = {add3(a.color, b.color), a.weight + b.weight};
    return sum;
}

// Before sample k is added to `sum`.
void begin_sample(Sum* whole, Sum* sum, Index k) {
    if (k % RT_PARTIAL_SUM != 0) return;
    *whole = add_sums(*whole, *sum);
    *sum = empty_sum();
}

PacketCounts no_counts(void) {
    PacketCounts counts = {(Indices)0, (Indices)0, (Indices)0, (Reals)0};
    return counts;
}

// Adds a packet's samples from `first` on to the sums of its pixels (x, y). Returns their colors.
real3 add_packet(const SceneView* scene, const Packet* packet, Indices x, Indices y, Index first,
                 Mask live, Sum* whole, Sum* sum, PacketCounts* used) {
    begin_sample(whole, sum, first);
    Indices k = first + packet->sample;
    real3 color = trace_sample(scene, x, y, k, live, used);
    Reals weight = sample_weight(&scene->params, x, y, k);
    sum->color.x = add_samples(sum->color.x, weight, color.x, packet->samples);
    sum->color.y = add_samples(sum->color.y, weight, color.y, packet->samples);
    sum->color.z = add_samples(sum->color.z, weight, color.z, packet->samples);
    sum->weight = add_samples(sum->weight, weight, (Reals)1, packet->samples);
    return color;
}

// The colors of a packet's pixels (x, y), in its first lanes: weighted means of their samples.
real3 trace_pixels(const SceneView* scene, const Packet* packet, Indices x, Indices y, Mask live,
                   RayCounts* counts) {
    Sum sum = empty_sum(), whole = sum;
    for (Index first = 0; first < scene->params.samples; first += packet->samples) {
        PacketCounts used = no_counts();
        add_packet(scene, packet, x, y, first, live, &whole, &sum, &used);
        count_lanes(counts, &used);
    }
    whole = add_sums(whole, sum);
    Index samples = packet->samples;
    return make3(average(whole.color.x, whole.weight, samples),
                 average(whole.color.y, whole.weight, samples),
                 average(whole.color.z, whole.weight, samples));
}

#endif
