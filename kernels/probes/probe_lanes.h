// SPDX-License-Identifier: Apache-2.0
//
// Moves the items of a probe (kernels/probes/probes.cl) into a packet's lanes and back: items at,
// at + 1.. of `count`. Lanes past the end take the last item again, and their results are
// discarded.
#ifndef RT_PROBE_LANES_H
#define RT_PROBE_LANES_H

#define PROBE_ITEMS uint first, uint count
#define PROBE_PACKET                                             \
    const uint at = (first + (uint)get_global_id(0)) * RT_LANES; \
    if (at >= count) return

// The items one by one, for functions that take one at a time.
#define PROBE_EACH_ITEM for (uint i = at; i < count && i < at + RT_LANES; ++i)

// The lanes one by one.
#define PROBE_EACH_LANE for (Index lane = 0; lane < RT_LANES; ++lane)
#define THIS_ITEM lane_item(at, count, lane)
#define THIS_LANE ((Mask)(RT_LANE_NUMBERS == lane))

// What is in memory for each kind of value in lanes.
#define PROBE_REALS Real
#define PROBE_REAL3 Packed3
#define PROBE_INDICES Index
#define PROBE_MASK Index
#define PROBE_UINTS uint

// Arrays of numbers, and members of arrays of structs.
#define REALS(array) get_reals(array, 1, at, count)
#define INDICES(array) get_indices(array, 1, at, count)
#define UINTS(array) get_uints(array, at, count)
#define REAL3(array) get3(&(array)->x, 3, at, count)
#define STEP(array) (sizeof(*(array)) / sizeof(Real))
#define REALS_OF(array, member) get_reals(&(array)->member, STEP(array), at, count)
#define INDICES_OF(array, member) get_indices(&(array)->member, STEP(array), at, count)
#define MASK_OF(array, member) (INDICES_OF(array, member) != 0)
#define REAL3_OF(array, member) get3(&(array)->member.x, STEP(array), at, count)

#define PUT_REALS(array, v) put_reals(array, 1, v, at, count)
#define PUT_INDICES(array, v) put_indices(array, 1, v, at, count)
#define PUT_MASK(array, v) put_indices(array, 1, (v)&1, at, count)
#define PUT_UINTS(array, v) put_uints(array, v, at, count)
#define PUT_REAL3(array, v) put3(&(array)->x, 3, v, at, count)
#define PUT_REALS_OF(array, member, v) put_reals(&(array)->member, STEP(array), v, at, count)
#define PUT_INDICES_OF(array, member, v) put_indices(&(array)->member, STEP(array), v, at, count)
#define PUT_MASK_OF(array, member, v) PUT_INDICES_OF(array, member, (v)&1)
#define PUT_REAL3_OF(array, member, v) put3(&(array)->member.x, STEP(array), v, at, count)

typedef union {
    Uints all;
    uint lane[RT_LANES];
} UintLanes;

size_t lane_item(uint at, uint count, Index lane) {
    uint i = at + (uint)lane;
    return i < count ? i : count - 1;
}

Reals get_reals(__global const Real* from, size_t step, uint at, uint count) {
    RealLanes v;
    PROBE_EACH_LANE v.lane[lane] = from[THIS_ITEM * step];
    return v.all;
}

Indices get_indices(__global const Index* from, size_t step, uint at, uint count) {
    IndexLanes v;
    PROBE_EACH_LANE v.lane[lane] = from[THIS_ITEM * step];
    return v.all;
}

Uints get_uints(__global const uint* from, uint at, uint count) {
    UintLanes v;
    PROBE_EACH_LANE v.lane[lane] = from[THIS_ITEM];
    return v.all;
}

real3 get3(__global const Real* from, size_t step, uint at, uint count) {
    return make3(get_reals(from, step, at, count), get_reals(from + 1, step, at, count),
                 get_reals(from + 2, step, at, count));
}

void put_reals(__global Real* to, size_t step, Reals v, uint at, uint count) {
    RealLanes lanes;
    lanes.all = v;
    PROBE_EACH_ITEM to[i * step] = lanes.lane[i - at];
}

void put_indices(__global Index* to, size_t step, Indices v, uint at, uint count) {
    IndexLanes lanes;
    lanes.all = v;
    PROBE_EACH_ITEM to[i * step] = lanes.lane[i - at];
}

void put_uints(__global uint* to, Uints v, uint at, uint count) {
    UintLanes lanes;
    lanes.all = v;
    PROBE_EACH_ITEM to[i] = lanes.lane[i - at];
}

void put3(__global Real* to, size_t step, real3 v, uint at, uint count) {
    put_reals(to, step, v.x, at, count);
    put_reals(to + 1, step, v.y, at, count);
    put_reals(to + 2, step, v.z, at, count);
}

#endif
