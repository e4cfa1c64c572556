// SPDX-License-Identifier: Apache-2.0
//
// The structs passed between the kernel tests and the probes besides those of kernels/shared.h, and
// how they get into lanes and back. tests/probe_types.h has the same structs in C++.
#ifndef RT_PROBE_STRUCTS_H
#define RT_PROBE_STRUCTS_H

#include "tests/probe_lanes.h"

typedef struct {
    Packed3 origin;
    Real t_max;
    Packed3 dir;
    Index from;
    Real self_hit;
    Packed3 dir_low, origin_low;
} ProbeRay;

typedef struct {
    Packed3 point;
    Real offset;
    Packed3 normal;
    Index material;
    Packed3 geometric;
    Real diameter;
    Packed3 point_low;
} ProbeSurface;

typedef struct {
    Index kx, ky, kz;
    Real origin_x, origin_y, origin_z;
    Real sx, sy, sz;
} ProbeShear;

typedef struct {
    Real t, u, v;
    Index prim, tied;
} ProbeHit;

typedef struct {
    ulong offset, bytes;
} ProbeField;

#define RAYS(array) get_ray(array, at, count)
#define HITS(array) get_hit(array, at, count)
#define SURFACES(array) get_surface(array, at, count)
#define PUT_RAY(array, v) put_ray(array, v, at, count)
#define PUT_HIT(array, v) put_hit(array, v, at, count)
#define PUT_SURFACE(array, v) put_surface(array, v, at, count)
#define PUT_COUNTS(array, v) put_counts(array, v, at, count)

Ray get_ray(__global const ProbeRay* rays, uint at, uint count) {
    Ray ray;
    ray.origin = REAL3_OF(rays, origin);
    ray.dir = REAL3_OF(rays, dir);
    ray.dir_low = REAL3_OF(rays, dir_low);
    ray.origin_low = REAL3_OF(rays, origin_low);
    ray.t_max = REALS_OF(rays, t_max);
    ray.from = INDICES_OF(rays, from);
    ray.self_hit = REALS_OF(rays, self_hit);
    ray.zone = (Reals)0;
    ray.left = ray.left_side = (Indices)0;
    return ray;
}

void put_ray(__global ProbeRay* rays, Ray ray, uint at, uint count) {
    PUT_REAL3_OF(rays, origin, ray.origin);
    PUT_REAL3_OF(rays, dir, ray.dir);
    PUT_REAL3_OF(rays, dir_low, ray.dir_low);
    PUT_REAL3_OF(rays, origin_low, ray.origin_low);
    PUT_REALS_OF(rays, t_max, ray.t_max);
    PUT_INDICES_OF(rays, from, ray.from);
    PUT_REALS_OF(rays, self_hit, ray.self_hit);
}

Hit get_hit(__global const ProbeHit* hits, uint at, uint count) {
    Hit hit;
    hit.t = REALS_OF(hits, t);
    hit.u = REALS_OF(hits, u);
    hit.v = REALS_OF(hits, v);
    hit.prim = INDICES_OF(hits, prim);
    hit.tied = INDICES_OF(hits, tied) != 0;
    return hit;
}

void put_hit(__global ProbeHit* hits, Hit hit, uint at, uint count) {
    PUT_REALS_OF(hits, t, hit.t);
    PUT_REALS_OF(hits, u, hit.u);
    PUT_REALS_OF(hits, v, hit.v);
    PUT_INDICES_OF(hits, prim, hit.prim);
    PUT_INDICES_OF(hits, tied, hit.tied & 1);
}

Surface get_surface(__global const ProbeSurface* surfaces, uint at, uint count) {
    Surface surface;
    surface.point = REAL3_OF(surfaces, point);
    surface.normal = REAL3_OF(surfaces, normal);
    surface.geometric = REAL3_OF(surfaces, geometric);
    surface.point_low = REAL3_OF(surfaces, point_low);
    surface.offset = REALS_OF(surfaces, offset);
    surface.material = INDICES_OF(surfaces, material);
    surface.signed_diameter = REALS_OF(surfaces, diameter);
    surface.back = (Reals)0;
    return surface;
}

void put_surface(__global ProbeSurface* surfaces, Surface surface, uint at, uint count) {
    PUT_REAL3_OF(surfaces, point, surface.point);
    PUT_REAL3_OF(surfaces, normal, surface.normal);
    PUT_REAL3_OF(surfaces, geometric, surface.geometric);
    PUT_REAL3_OF(surfaces, point_low, surface.point_low);
    PUT_REALS_OF(surfaces, offset, surface.offset);
    PUT_INDICES_OF(surfaces, material, surface.material);
    PUT_REALS_OF(surfaces, diameter, surface.signed_diameter);
}

// Initial values of lanes that are then filled one by one.

Hit no_hit() {
    Hit hit = {(Reals)-1, (Reals)0, (Reals)0, (Indices)0, RT_NO_LANES};
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
        counts[i].shadow = (ulong)shadow.lane[i - at];
        counts[i].mirror = (ulong)mirror.lane[i - at];
        counts[i].transmitted = (ulong)transmitted.lane[i - at];
    }
}

#endif
