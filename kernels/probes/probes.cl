// SPDX-License-Identifier: Apache-2.0
//
// One tiny entry point per device function, for the kernel tests: probe_FUNCTION takes the number
// of the first packet and the number of items, then one array for each argument and one for each
// result. A host test runs it with run<...>("FUNCTION", ...) (tests/kernel_runner.h). 3-vectors,
// rays and surfaces are passed packed, as everything in memory is.
//
// A packet holds RT_LANES items, one per lane. A function that takes one primitive for all lanes is
// called once per lane with that lane's primitive, and only that lane's result is kept.
#ifdef RT_ITEM  // PoCL (kernels/render.cl): most probes that take a scene search it
#define RT_SEARCH_OUT_OF_LINE RT_ITEM
#endif
#include "kernels/render.cl"
// It uses the tracer's types.
#include "kernels/probes/probe_structs.h"

// PROBE2(dot3, REALS, REAL3, REAL3): the entry point of dot3, whose result is one number for each
// lane, from two arguments of three. The kinds are those of probe_lanes.h.
#define PROBE_IN(kind, name) __global const PROBE_##kind* name
#define PROBE_OUT(kind) __global PROBE_##kind* out
#define PROBE1(function, result, A)                                                  \
    __kernel void probe_##function(PROBE_ITEMS, PROBE_IN(A, a), PROBE_OUT(result)) { \
        PROBE_PACKET;                                                                \
        PUT_##result(out, function(A(a)));                                           \
    }
#define PROBE2(function, result, A, B)                                          \
    __kernel void probe_##function(PROBE_ITEMS, PROBE_IN(A, a), PROBE_IN(B, b), \
                                   PROBE_OUT(result)) {                         \
        PROBE_PACKET;                                                           \
        PUT_##result(out, function(A(a), B(b)));                                \
    }
#define PROBE3(function, result, A, B, C)                                                       \
    __kernel void probe_##function(PROBE_ITEMS, PROBE_IN(A, a), PROBE_IN(B, b), PROBE_IN(C, c), \
                                   PROBE_OUT(result)) {                                         \
        PROBE_PACKET;                                                                           \
        PUT_##result(out, function(A(a), B(b), C(c)));                                          \
    }
#define PROBE4(function, result, A, B, C, D)                                                    \
    __kernel void probe_##function(PROBE_ITEMS, PROBE_IN(A, a), PROBE_IN(B, b), PROBE_IN(C, c), \
                                   PROBE_IN(D, d), PROBE_OUT(result)) {                         \
        PROBE_PACKET;                                                                           \
        PUT_##result(out, function(A(a), B(b), C(c), D(d)));                                    \
    }

// bits.cl, power.cl

PROBE1(log2_tail, REALS, REALS)
PROBE1(log2_series, REALS, REALS)
PROBE1(exp2_series, REALS, REALS)
PROBE2(one_ulp_towards, REALS, REALS, REALS)
PROBE3(log2_cosine, REALS, REALS, REALS, REALS)
PROBE2(exp2_of_product, REALS, REALS, REALS)
PROBE4(blinn_lobe, REALS, REALS, REALS, REALS, REALS)

// What all of them are made of: the device's own arithmetic.

Reals product(Reals a, Reals b) { return a * b; }
Reals quotient(Reals a, Reals b) { return a / b; }
Reals square_root(Reals a) { return sqrt(a); }
Reals fused(Reals a, Reals b, Reals c) { return fma(a, b, c); }
Uints shifted(Uints a, Uints b) { return (a << (b & 31)) ^ (a >> (b & 31)); }

PROBE2(product, REALS, REALS, REALS)
PROBE2(quotient, REALS, REALS, REALS)
PROBE1(square_root, REALS, REALS)
PROBE3(fused, REALS, REALS, REALS, REALS)
PROBE2(shifted, UINTS, UINTS, UINTS)

// math.cl

Reals multiply_add(Reals a, Reals b, Reals c) { return a * b + c; }

__kernel void probe_load3(PROBE_ITEMS, __global const Packed3* a, __global Packed3* out) {
    PROBE_PACKET;
    real3 loaded = make3((Reals)0, (Reals)0, (Reals)0);
    PROBE_EACH_LANE loaded = select3(THIS_LANE, load3(a[THIS_ITEM]), loaded);
    PUT_REAL3(out, loaded);
}

PROBE2(min_of, REALS, REALS, REALS)
PROBE2(max_of, REALS, REALS, REALS)
PROBE2(dot3, REALS, REAL3, REAL3)
PROBE3(add_scaled, REAL3, REAL3, REALS, REAL3)
PROBE3(multiply_add, REALS, REALS, REALS, REALS)
PROBE1(length3, REALS, REAL3)
PROBE1(abs3, REAL3, REAL3)
PROBE1(negate3, REAL3, REAL3)
PROBE1(normalize3, REAL3, REAL3)
PROBE2(add3, REAL3, REAL3, REAL3)
PROBE2(sub3, REAL3, REAL3, REAL3)
PROBE2(mul3, REAL3, REAL3, REAL3)
PROBE2(reflect3, REAL3, REAL3, REAL3)
PROBE2(cross3, REAL3, REAL3, REAL3)
PROBE2(scale3, REAL3, REALS, REAL3)
PROBE2(divide3, REAL3, REAL3, REALS)
PROBE4(difference_of_products, REALS, REALS, REALS, REALS, REALS)

// camera.cl, intersect.cl, cone.cl

__kernel void probe_camera_ray(PROBE_ITEMS, __global const LaunchParams* params,
                               __global const Index* x, __global const Index* y,
                               __global const Index* k, __global ProbeRay* out) {
    PROBE_PACKET;
    LaunchParams copy = *params;
    PUT_RAY(out, camera_ray(&copy, INDICES(x), INDICES(y), INDICES(k)));
}

__kernel void probe_intersect_sphere(PROBE_ITEMS, __global const ProbeRay* rays,
                                     __global const Sphere* spheres, __global Real* out) {
    PROBE_PACKET;
    Ray ray = RAYS(rays);
    Reals found = (Reals)-1;
    PROBE_EACH_LANE {
        Reals t = (Reals)0;
        Mask met = intersect_sphere(&ray, &spheres[THIS_ITEM], (Index)THIS_ITEM, &t);
        found = (THIS_LANE & met) ? t : found;
    }
    PUT_REALS(out, found);
}

__kernel void probe_intersect_cone(PROBE_ITEMS, __global const ProbeRay* rays,
                                   __global const Cone* cones, __global const Index* leaving,
                                   __global Real* out) {
    PROBE_PACKET;
    Ray ray = RAYS(rays);
    Mask leaves = INDICES(leaving) != 0;
    Reals found = (Reals)-1;
    PROBE_EACH_LANE {
        Reals t = (Reals)0, far;
        Mask met = intersect_cone(&ray, &cones[THIS_ITEM], leaves, &t, &far);
        found = (THIS_LANE & met) ? t : found;
    }
    PUT_REALS(out, found);
}

PROBE2(component3, REALS, REAL3, INDICES)

__kernel void probe_make_shear(PROBE_ITEMS, __global const ProbeRay* rays,
                               __global ProbeShear* out) {
    PROBE_PACKET;
    Ray ray = RAYS(rays);
    RayShear shear = make_shear(&ray, RT_ALL_LANES);
    PUT_INDICES_OF(out, kx, next_axis(shear.axis));
    PUT_INDICES_OF(out, ky, next_axis(next_axis(shear.axis)));
    PUT_INDICES_OF(out, kz, shear.axis);
    PUT_REALS_OF(out, origin_x, shear.origin.x);
    PUT_REALS_OF(out, origin_y, shear.origin.y);
    PUT_REALS_OF(out, origin_z, shear.origin.z);
    PUT_REALS_OF(out, sx, shear.sx);
    PUT_REALS_OF(out, sy, shear.sy);
    PUT_REALS_OF(out, sz, shear.sz);
}

__kernel void probe_shear_vertex(PROBE_ITEMS, __global const ProbeRay* rays,
                                 __global const Packed3* vertices, __global Packed3* out) {
    PROBE_PACKET;
    Ray ray = RAYS(rays);
    real3 sheared = make3((Reals)0, (Reals)0, (Reals)0);
    PROBE_EACH_LANE {
        RayShear shear = make_shear(&ray, THIS_LANE);
        real3 vertex = shear_vertex(&shear, &vertices[THIS_ITEM]);
        sheared = select3(THIS_LANE, vertex, sheared);
    }
    PUT_REAL3(out, sheared);
}

__kernel void probe_intersect_triangle(PROBE_ITEMS, __global const ProbeRay* rays,
                                       __global const Triangle* triangles, __global ProbeHit* out) {
    PROBE_PACKET;
    Ray ray = RAYS(rays);
    Hit hit = no_hit();
    PROBE_EACH_LANE {
        RayShear shear = make_shear(&ray, THIS_LANE);
        Reals t = (Reals)0, u = (Reals)0, v = (Reals)0;
        Mask met = intersect_triangle(&shear, &triangles[THIS_ITEM], &t, &u, &v) & THIS_LANE;
        hit.t = met ? t : hit.t;
        hit.u = met ? u : hit.u;
        hit.v = met ? v : hit.v;
    }
    PUT_HIT(out, hit);
}

// bvh.cl, closest_hit.cl

// Where the rays enter the boxes; -1 where they do not.
__kernel void probe_meets_box(PROBE_ITEMS, __global const ProbeRay* rays,
                              __global const BvhNode* boxes, __global Real* out) {
    PROBE_PACKET;
    Ray ray = RAYS(rays);
    Traversal traversal = begin_traversal(&ray, RT_ALL_LANES);
    Reals found = (Reals)-1;
    PROBE_EACH_LANE {
        Reals entry;
        Mask meets = meets_box(&traversal, &boxes[THIS_ITEM], ray.t_max, &entry);
        found = (THIS_LANE & meets) ? entry : found;
    }
    PUT_REALS(out, found);
}

// surface.cl, hit_surface.cl

#define PROBE_SURFACE_OF(function, Primitive)                                                    \
    __kernel void probe_##function(PROBE_ITEMS, __global const ProbeRay* rays,                   \
                                   __global const Real* t, __global const Primitive* primitives, \
                                   __global ProbeSurface* out) {                                 \
        PROBE_PACKET;                                                                            \
        Ray ray = RAYS(rays);                                                                    \
        Surface surface = no_surface();                                                          \
        PROBE_EACH_LANE {                                                                        \
            Surface met = function(&ray, REALS(t), &primitives[THIS_ITEM]);                      \
            surface = select_surface(THIS_LANE, met, surface);                                   \
        }                                                                                        \
        PUT_SURFACE(out, surface);                                                               \
    }
PROBE_SURFACE_OF(sphere_surface, Sphere)
PROBE_SURFACE_OF(cone_surface, Cone)

__kernel void probe_blended_normal(PROBE_ITEMS, __global const VertexNormals* normals,
                                   __global const Packed3* faces, __global const Real* u,
                                   __global const Real* v, __global Packed3* out) {
    PROBE_PACKET;
    real3 blended = make3((Reals)0, (Reals)0, (Reals)0);
    PROBE_EACH_LANE {
        real3 normal = blended_normal(&normals[THIS_ITEM], REAL3(faces), REALS(u), REALS(v));
        blended = select3(THIS_LANE, normal, blended);
    }
    PUT_REAL3(out, blended);
}

__kernel void probe_triangle_surface(PROBE_ITEMS, __global const ProbeRay* rays,
                                     __global const ProbeHit* hits,
                                     __global const Triangle* triangles,
                                     __global const VertexNormals* vertex_normals,
                                     __global ProbeSurface* out) {
    PROBE_PACKET;
    Ray ray = RAYS(rays);
    Hit hit = HITS(hits);
    Surface surface = no_surface();
    PROBE_EACH_LANE {
        Surface met = triangle_surface(&ray, &hit, &triangles[THIS_ITEM], vertex_normals);
        surface = select_surface(THIS_LANE, met, surface);
    }
    PUT_SURFACE(out, surface);
}

__kernel void probe_offset_origin(PROBE_ITEMS, __global const ProbeSurface* surfaces,
                                  __global const Packed3* sides, __global Packed3* out) {
    PROBE_PACKET;
    Surface surface = SURFACES(surfaces);
    PUT_REAL3(out, offset_origin(&surface, REAL3(sides)));
}

__kernel void probe_spawn_ray(PROBE_ITEMS, __global const ProbeSurface* surfaces,
                              __global const Packed3* origins, __global const Packed3* dirs,
                              __global const Index* prims, __global ProbeRay* out) {
    PROBE_PACKET;
    Surface surface = SURFACES(surfaces);
    PUT_RAY(out, spawn_ray(&surface, REAL3(origins), REAL3(dirs), INDICES(prims)));
}

// material.cl, shade.cl

PROBE1(is_black, MASK, REAL3)
PROBE4(specular_lobe, REALS, REAL3, REAL3, REAL3, REALS)

// whitted.cl

__kernel void probe_mirror_ray(PROBE_ITEMS, __global const ProbeSurface* surfaces,
                               __global const Packed3* dirs, __global const Index* prims,
                               __global ProbeRay* out) {
    PROBE_PACKET;
    Surface surface = SURFACES(surfaces);
    PUT_RAY(out, mirror_ray(&surface, REAL3(dirs), INDICES(prims)));
}

__kernel void probe_refracted_ray(PROBE_ITEMS, __global const ProbeSurface* surfaces,
                                  __global const Packed3* dirs, __global const Real* eta,
                                  __global const Index* prims, __global ProbeRay* out,
                                  __global Index* total) {
    PROBE_PACKET;
    Surface surface = SURFACES(surfaces);
    Mask is_total;
    PUT_RAY(out, refracted_ray(&surface, REAL3(dirs), REALS(eta), INDICES(prims), &is_total));
    PUT_MASK(total, is_total);
}

// packet.cl, film.cl

__kernel void probe_store3(PROBE_ITEMS, __global const Packed3* colors, __global Packed3* out) {
    PROBE_PACKET;
    PROBE_EACH_ITEM {
        store3((__global Real*)out, (Index)i, colors[i].x, colors[i].y, colors[i].z);
    }
}

__kernel void probe_add_counts(PROBE_ITEMS, __global const RayCounts* a,
                               __global const RayCounts* b, __global RayCounts* out) {
    PROBE_PACKET;
    PROBE_EACH_ITEM {
        out[i] = a[i];
        add_counts(out, i, b[i]);
    }
}

// sampling.cl

PROBE1(reverse_bits, UINTS, UINTS)
PROBE3(swap_bits, UINTS, UINTS, UINTS, UINTS)
PROBE1(hash_bits, UINTS, UINTS)
PROBE2(owen_scramble, UINTS, UINTS, UINTS)
PROBE1(sobol_second, UINTS, UINTS)
PROBE1(unit_from_bits, REALS, UINTS)

__kernel void probe_sobol_position(PROBE_ITEMS, __global const uint* seed, __global const uint* k,
                                   __global Real* x, __global Real* y) {
    PROBE_PACKET;
    Position position = sobol_position(UINTS(seed), UINTS(k));
    PUT_REALS(x, position.x);
    PUT_REALS(y, position.y);
}

__kernel void probe_grid_position(PROBE_ITEMS, __global const Index* grid, __global const Index* k,
                                  __global Real* x, __global Real* y) {
    PROBE_PACKET;
    Reals across = (Reals)0, up = (Reals)0;
    PROBE_EACH_LANE {
        Position position = grid_position(grid[THIS_ITEM], INDICES(k));
        across = THIS_LANE ? position.x : across;
        up = THIS_LANE ? position.y : up;
    }
    PUT_REALS(x, across);
    PUT_REALS(y, up);
}

__kernel void probe_filter_radius(PROBE_ITEMS, __global const Index* filter, __global Real* out) {
    PROBE_PACKET;
    PROBE_EACH_ITEM out[i] = filter_radius(filter[i]);
}

PROBE1(mitchell_weight, REALS, REALS)

__kernel void probe_filter_weight(PROBE_ITEMS, __global const Index* filter, __global const Real* d,
                                  __global Real* out) {
    PROBE_PACKET;
    Reals weight = (Reals)0;
    PROBE_EACH_LANE { weight = THIS_LANE ? filter_weight(filter[THIS_ITEM], REALS(d)) : weight; }
    PUT_REALS(out, weight);
}

// unit_position, sample_position and sample_weight of one sample.
__kernel void probe_sample(PROBE_ITEMS, __global const LaunchParams* params,
                           __global const Index* x, __global const Index* y,
                           __global const Index* k, __global Real* unit_x, __global Real* unit_y,
                           __global Real* sample_x, __global Real* sample_y,
                           __global Real* weight) {
    PROBE_PACKET;
    LaunchParams f = *params;
    Position unit = unit_position(&f, INDICES(x), INDICES(y), INDICES(k));
    Position sample = sample_position(&f, INDICES(x), INDICES(y), INDICES(k));
    PUT_REALS(unit_x, unit.x);
    PUT_REALS(unit_y, unit.y);
    PUT_REALS(sample_x, sample.x);
    PUT_REALS(sample_y, sample.y);
    PUT_REALS(weight, sample_weight(&f, INDICES(x), INDICES(y), INDICES(k)));
}

#ifndef RT_SCENE_PROBES
#define RT_SCENE_PROBES 1
#endif
#if RT_SCENE_PROBES
#include "kernels/probes/scene_probes.cl"
#endif
