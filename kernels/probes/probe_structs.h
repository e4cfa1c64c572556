// SPDX-License-Identifier: Apache-2.0
//
// The structs passed between the kernel tests and the probes besides those of kernels/shared.h.
#ifndef RT_PROBE_STRUCTS_H
#define RT_PROBE_STRUCTS_H

#include "kernels/probes/probe_fields.h"
#include "kernels/probes/probe_lanes.h"

// Probe##Type, whose members are those of Type that tests set, and how it gets into lanes and back.
// `rest` sets the other members.
#define MEMBER(kind, name) PROBE_##kind name;
#define GET_MEMBER(kind, name) value.name = kind##_OF(array, name);
#define PUT_MEMBER(kind, name) PUT_##kind##_OF(array, name, value.name);
#define PROBE_STRUCT(Type, MEMBERS, rest)                                           \
    typedef struct {                                                                \
        MEMBERS(MEMBER)                                                             \
    } Probe##Type;                                                                  \
    Type get_##Type(__global const Probe##Type* array, uint at, uint count) {       \
        Type value;                                                                 \
        MEMBERS(GET_MEMBER)                                                         \
        rest;                                                                       \
        return value;                                                               \
    }                                                                               \
    void put_##Type(__global Probe##Type* array, Type value, uint at, uint count) { \
        MEMBERS(PUT_MEMBER)                                                         \
    }

PROBE_STRUCT(Ray, PROBE_RAY, value.zone = (Reals)0; value.left = value.left_side = (Indices)0)
PROBE_STRUCT(Hit, PROBE_HIT, )
PROBE_STRUCT(Surface, PROBE_SURFACE, value.back = (Reals)0)

#define RAYS(array) get_Ray(array, at, count)
#define HITS(array) get_Hit(array, at, count)
#define SURFACES(array) get_Surface(array, at, count)
#define PUT_RAY(array, v) put_Ray(array, v, at, count)
#define PUT_HIT(array, v) put_Hit(array, v, at, count)
#define PUT_SURFACE(array, v) put_Surface(array, v, at, count)
#define PUT_COUNTS(array, v) put_counts(array, v, at, count)

typedef struct {
    Index kx, ky, kz;
    Real origin_x, origin_y, origin_z;
    Real sx, sy, sz;
} ProbeShear;

// Initial values of lanes that are then filled one by one.

Hit no_hit() {
    Hit hit = {(Reals)-1, (Reals)0, (Reals)0, (Indices)0, RT_NO_LANES, (Reals)0};
    return hit;
}

Surface no_surface() {
    const real3 zero = make3((Reals)0, (Reals)0, (Reals)0);
    Surface surface = {zero, zero, zero, zero, (Reals)0, (Reals)0, (Reals)0, (Indices)0};
    return surface;
}

void put_counts(__global RayCounts* counts, PacketCounts used, uint at, uint count) {
    IndexLanes shadow, mirror, transmitted;
    shadow.all = used.shadow;
    mirror.all = used.mirror;
    transmitted.all = used.transmitted;
    PROBE_EACH_ITEM {
        counts[i].primary = 0;
        counts[i].shadow = (ulong)shadow.lane[i - at];
        counts[i].mirror = (ulong)mirror.lane[i - at];
        counts[i].transmitted = (ulong)transmitted.lane[i - at];
    }
}

#endif
