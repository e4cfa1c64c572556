// SPDX-License-Identifier: Apache-2.0
//
// One tiny entry point per device function, for the kernel tests: probe_FUNCTION takes the numbers
// of the first item and of all items, then one array for each argument and one for each result.
// A host test runs it with run<...>("FUNCTION", ...) (tests/kernel_runner.h). 3-vectors, rays and
// surfaces travel packed, as everything in memory does.
#include "kernels/render.cl"

#define PROBE_ITEMS uint first, uint count
#define PROBE_ITEM                       \
    size_t i = first + get_global_id(0); \
    if (i >= count) return
#define PROBE_SCENE                                                                       \
    __global const Sphere *spheres, __global const Cone *cones,                           \
        __global const Triangle *triangles, __global const VertexNormals *vertex_normals, \
        __global const Material *materials, __global const Light *lights,                 \
        __global const BvhNode *nodes, __global const Index *listed,                      \
        __global const Index *casters, __global const Frame *frame
#define PROBE_SCENE_VIEW \
    { spheres, cones, triangles, vertex_normals, materials, lights, nodes, listed, casters, *frame }

typedef struct {
    Packed3 origin;
    Real t_max;
    Packed3 dir;
    Index from;
    Real chord;
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

Packed3 pack(real3 v) {
    Packed3 packed = {v.x, v.y, v.z};
    return packed;
}

Ray unpack_ray(ProbeRay packed) {
    Ray ray;
    ray.origin = load3(packed.origin);
    ray.dir = load3(packed.dir);
    ray.dir_low = load3(packed.dir_low);
    ray.origin_low = load3(packed.origin_low);
    ray.t_max = packed.t_max;
    ray.from = packed.from;
    ray.chord = packed.chord;
    return ray;
}

Hit unpack_hit(ProbeHit packed) {
    Hit hit = {packed.t, packed.u, packed.v, packed.prim, packed.tied != 0};
    return hit;
}

ProbeHit pack_hit(Hit hit) {
    ProbeHit packed = {hit.t, hit.u, hit.v, hit.prim, hit.tied};
    return packed;
}

RayCounts pack_counts(PacketCounts counts) {
    RayCounts packed = {0, 0, 0};
    count_lanes(&packed, &counts);
    return packed;
}

// The finish of a surface of a probe's scene.
Finish probe_finish(const SceneView* scene, const Surface* surface) {
    return finish_of(scene, surface->material, RT_ALL_LANES);
}

ProbeRay pack_ray(Ray ray) {
    ProbeRay packed = {pack(ray.origin), ray.t_max,         pack(ray.dir),       ray.from,
                       ray.chord,        pack(ray.dir_low), pack(ray.origin_low)};
    return packed;
}

Surface unpack_surface(ProbeSurface packed) {
    Surface surface;
    surface.point = load3(packed.point);
    surface.normal = load3(packed.normal);
    surface.geometric = load3(packed.geometric);
    surface.offset = packed.offset;
    surface.material = packed.material;
    surface.diameter = packed.diameter;
    surface.point_low = load3(packed.point_low);
    return surface;
}

ProbeSurface pack_surface(Surface s) {
    ProbeSurface packed = {pack(s.point),     s.offset,   pack(s.normal),   s.material,
                           pack(s.geometric), s.diameter, pack(s.point_low)};
    return packed;
}

// shared.h: offset and size of entry i of tests/layout_fields.h

__kernel void probe_layout(PROBE_ITEMS, __global ProbeField* out) {
    PROBE_ITEM;
    size_t n = 0;
#define RT_STRUCT(type)              \
    if (n++ == i) {                  \
        out[i].offset = 0;           \
        out[i].bytes = sizeof(type); \
    }
#define RT_FIELD(type, member)                                           \
    if (n++ == i) {                                                      \
        type object;                                                     \
        out[i].offset = (ulong)((char*)&object.member - (char*)&object); \
        out[i].bytes = sizeof(object.member);                            \
    }
#include "tests/layout_fields.h"
}

// One number in, one out

#define PROBE_UNARY(function)                                                                 \
    __kernel void probe_##function(PROBE_ITEMS, __global const Real* x, __global Real* out) { \
        PROBE_ITEM;                                                                           \
        out[i] = function(x[i]);                                                              \
    }
PROBE_UNARY(log2_tail)
PROBE_UNARY(log2_series)
PROBE_UNARY(exp2_series)

// bits.cl, power.cl

__kernel void probe_one_ulp_towards(PROBE_ITEMS, __global const Real* x,
                                    __global const Real* direction, __global Real* out) {
    PROBE_ITEM;
    out[i] = one_ulp_towards(x[i], direction[i]);
}

__kernel void probe_log2_cosine(PROBE_ITEMS, __global const Real* along,
                                __global const Real* across, __global const Real* squared,
                                __global Real* out) {
    PROBE_ITEM;
    out[i] = log2_cosine(along[i], across[i], squared[i]);
}

__kernel void probe_exp2_of_product(PROBE_ITEMS, __global const Real* a, __global const Real* b,
                                    __global Real* out) {
    PROBE_ITEM;
    out[i] = exp2_of_product(a[i], b[i]);
}

__kernel void probe_blinn_lobe(PROBE_ITEMS, __global const Real* along, __global const Real* across,
                               __global const Real* squared, __global const Real* exponent,
                               __global Real* out) {
    PROBE_ITEM;
    out[i] = blinn_lobe(along[i], across[i], squared[i], exponent[i]);
}

// math.cl

__kernel void probe_load3(PROBE_ITEMS, __global const Packed3* a, __global Packed3* out) {
    PROBE_ITEM;
    out[i] = pack(load3(a[i]));
}

__kernel void probe_dot3(PROBE_ITEMS, __global const Packed3* a, __global const Packed3* b,
                         __global Real* out) {
    PROBE_ITEM;
    out[i] = dot3(load3(a[i]), load3(b[i]));
}

__kernel void probe_add_scaled(PROBE_ITEMS, __global const Packed3* a, __global const Real* s,
                               __global const Packed3* b, __global Packed3* out) {
    PROBE_ITEM;
    out[i] = pack(add_scaled(load3(a[i]), s[i], load3(b[i])));
}

__kernel void probe_multiply_add(PROBE_ITEMS, __global const Real* a, __global const Real* b,
                                 __global const Real* c, __global Real* out) {
    PROBE_ITEM;
    out[i] = a[i] * b[i] + c[i];
}

__kernel void probe_length3(PROBE_ITEMS, __global const Packed3* a, __global Real* out) {
    PROBE_ITEM;
    out[i] = length3(load3(a[i]));
}

#define PROBE_UNARY3(function)                                             \
    __kernel void probe_##function(PROBE_ITEMS, __global const Packed3* a, \
                                   __global Packed3* out) {                \
        PROBE_ITEM;                                                        \
        out[i] = pack(function(load3(a[i])));                              \
    }
PROBE_UNARY3(abs3)
PROBE_UNARY3(negate3)
PROBE_UNARY3(normalize3)

#define PROBE_BINARY3(function)                                                        \
    __kernel void probe_##function(PROBE_ITEMS, __global const Packed3* a,             \
                                   __global const Packed3* b, __global Packed3* out) { \
        PROBE_ITEM;                                                                    \
        out[i] = pack(function(load3(a[i]), load3(b[i])));                             \
    }
PROBE_BINARY3(add3)
PROBE_BINARY3(sub3)
PROBE_BINARY3(mul3)
PROBE_BINARY3(reflect3)

__kernel void probe_scale3(PROBE_ITEMS, __global const Real* s, __global const Packed3* v,
                           __global Packed3* out) {
    PROBE_ITEM;
    out[i] = pack(scale3(s[i], load3(v[i])));
}

__kernel void probe_divide3(PROBE_ITEMS, __global const Packed3* v, __global const Real* s,
                            __global Packed3* out) {
    PROBE_ITEM;
    out[i] = pack(divide3(load3(v[i]), s[i]));
}

__kernel void probe_difference_of_products(PROBE_ITEMS, __global const Real* a,
                                           __global const Real* b, __global const Real* c,
                                           __global const Real* d, __global Real* out) {
    PROBE_ITEM;
    out[i] = difference_of_products(a[i], b[i], c[i], d[i]);
}

// camera.cl, intersect.cl

__kernel void probe_camera_ray(PROBE_ITEMS, __global const Frame* frame, __global const Index* x,
                               __global const Index* y, __global const Index* k,
                               __global ProbeRay* out) {
    PROBE_ITEM;
    Frame copy = *frame;
    out[i] = pack_ray(camera_ray(&copy, x[i], y[i], k[i]));
}

__kernel void probe_intersect_sphere(PROBE_ITEMS, __global const ProbeRay* rays,
                                     __global const Sphere* spheres, __global Real* out) {
    PROBE_ITEM;
    Ray ray = unpack_ray(rays[i]);
    Real t;
    out[i] = intersect_sphere(&ray, &spheres[i], (Index)i, &t) ? t : -1;
}

__kernel void probe_cross3(PROBE_ITEMS, __global const Packed3* a, __global const Packed3* b,
                           __global Packed3* out) {
    PROBE_ITEM;
    out[i] = pack(cross3(load3(a[i]), load3(b[i])));
}

__kernel void probe_intersect_cone(PROBE_ITEMS, __global const ProbeRay* rays,
                                   __global const Cone* cones, __global const Index* leaving,
                                   __global Real* out) {
    PROBE_ITEM;
    Ray ray = unpack_ray(rays[i]);
    Real t;
    out[i] = intersect_cone(&ray, &cones[i], leaving[i] != 0, &t) ? t : -1;
}

__kernel void probe_cone_surface(PROBE_ITEMS, __global const ProbeRay* rays, __global const Real* t,
                                 __global const Cone* cones, __global ProbeSurface* out) {
    PROBE_ITEM;
    Ray ray = unpack_ray(rays[i]);
    out[i] = pack_surface(cone_surface(&ray, t[i], &cones[i]));
}

__kernel void probe_component3(PROBE_ITEMS, __global const Packed3* v, __global const Index* k,
                               __global Real* out) {
    PROBE_ITEM;
    out[i] = component3(load3(v[i]), k[i]);
}

__kernel void probe_make_shear(PROBE_ITEMS, __global const ProbeRay* rays,
                               __global ProbeShear* out) {
    PROBE_ITEM;
    Ray ray = unpack_ray(rays[i]);
    RayShear s = make_shear(&ray, RT_ALL_LANES);
    ProbeShear packed = {next_axis(s.axis),
                         next_axis(next_axis(s.axis)),
                         s.axis,
                         s.origin.x,
                         s.origin.y,
                         s.origin.z,
                         s.sx,
                         s.sy,
                         s.sz};
    out[i] = packed;
}

__kernel void probe_shear_vertex(PROBE_ITEMS, __global const ProbeRay* rays,
                                 __global const Packed3* vertices, __global Packed3* out) {
    PROBE_ITEM;
    Ray ray = unpack_ray(rays[i]);
    RayShear shear = make_shear(&ray, RT_ALL_LANES);
    out[i] = pack(shear_vertex(&shear, shear.axis, &vertices[i]));
}

__kernel void probe_intersect_triangle(PROBE_ITEMS, __global const ProbeRay* rays,
                                       __global const Triangle* triangles, __global ProbeHit* out) {
    PROBE_ITEM;
    Ray ray = unpack_ray(rays[i]);
    RayShear shear = make_shear(&ray, RT_ALL_LANES);
    ProbeHit hit = {-1, 0, 0, 0, 0};
    Real t, u, v;
    if (intersect_triangle(&shear, shear.axis, &triangles[i], &t, &u, &v)) {
        hit.t = t;
        hit.u = u;
        hit.v = v;
    }
    out[i] = hit;
}

// closest_hit.cl

// Distance to primitive prims[i] alone.
__kernel void probe_intersect_primitive(PROBE_ITEMS, PROBE_SCENE, __global const ProbeRay* rays,
                                        __global const Index* prims, __global ProbeHit* out) {
    PROBE_ITEM;
    Ray ray = unpack_ray(rays[i]);
    RayShear shear = make_shear(&ray, RT_ALL_LANES);
    ProbeHit hit = {-1, 0, 0, prims[i], 0};
    Real t, u, v;
    Index cone = prims[i] - frame->sphere_count;
    Index triangle = cone - frame->cone_count;
    if (cone < 0) {
        if (intersect_sphere(&ray, &spheres[prims[i]], prims[i], &t)) hit.t = t;
    } else if (triangle < 0) {
        if (intersect_cone(&ray, &cones[cone], ray.from == prims[i], &t)) hit.t = t;
    } else if (ray.from != prims[i] &&
               intersect_triangle(&shear, shear.axis, &triangles[triangle], &t, &u, &v)) {
        hit.t = t;
    }
    out[i] = hit;
}

__kernel void probe_closest_hit(PROBE_ITEMS, PROBE_SCENE, __global const ProbeRay* rays,
                                __global ProbeHit* out) {
    PROBE_ITEM;
    SceneView scene = PROBE_SCENE_VIEW;
    Ray ray = unpack_ray(rays[i]);
    out[i] = pack_hit(closest_hit(&scene, &ray, RT_ALL_LANES));
}

__kernel void probe_any_hit(PROBE_ITEMS, PROBE_SCENE, __global const ProbeRay* rays,
                            __global Index* out) {
    PROBE_ITEM;
    SceneView scene = PROBE_SCENE_VIEW;
    Ray ray = unpack_ray(rays[i]);
    out[i] = any_hit(&scene, &ray, 0, frame->triangle_count);
}

// surface.cl

__kernel void probe_sphere_surface(PROBE_ITEMS, __global const ProbeRay* rays,
                                   __global const Real* t, __global const Sphere* spheres,
                                   __global ProbeSurface* out) {
    PROBE_ITEM;
    Ray ray = unpack_ray(rays[i]);
    out[i] = pack_surface(sphere_surface(&ray, t[i], &spheres[i]));
}

__kernel void probe_blended_normal(PROBE_ITEMS, __global const VertexNormals* normals,
                                   __global const Packed3* faces, __global const Real* u,
                                   __global const Real* v, __global Packed3* out) {
    PROBE_ITEM;
    out[i] = pack(blended_normal(&normals[i], load3(faces[i]), u[i], v[i]));
}

__kernel void probe_triangle_surface(PROBE_ITEMS, __global const ProbeRay* rays,
                                     __global const ProbeHit* hits,
                                     __global const Triangle* triangles,
                                     __global const VertexNormals* vertex_normals,
                                     __global ProbeSurface* out) {
    PROBE_ITEM;
    Ray ray = unpack_ray(rays[i]);
    Hit hit = unpack_hit(hits[i]);
    out[i] = pack_surface(triangle_surface(&ray, &hit, &triangles[i], vertex_normals));
}

__kernel void probe_primitive_surface(PROBE_ITEMS, PROBE_SCENE, __global const ProbeRay* rays,
                                      __global const ProbeHit* hits, __global ProbeSurface* out) {
    PROBE_ITEM;
    SceneView scene = PROBE_SCENE_VIEW;
    Ray ray = unpack_ray(rays[i]);
    Hit hit = unpack_hit(hits[i]);
    out[i] = pack_surface(primitive_surface(&scene, &ray, &hit, hit.prim));
}

__kernel void probe_is_on_edge(PROBE_ITEMS, PROBE_SCENE, __global const ProbeHit* hits,
                               __global Index* out) {
    PROBE_ITEM;
    SceneView scene = PROBE_SCENE_VIEW;
    Hit hit = unpack_hit(hits[i]);
    out[i] = is_on_edge(&scene, &hit);
}

__kernel void probe_surface_at(PROBE_ITEMS, PROBE_SCENE, __global const ProbeRay* rays,
                               __global const ProbeHit* hits, __global ProbeSurface* out) {
    PROBE_ITEM;
    SceneView scene = PROBE_SCENE_VIEW;
    Ray ray = unpack_ray(rays[i]);
    Hit hit = unpack_hit(hits[i]);
    out[i] = pack_surface(surface_at(&scene, &ray, &hit, RT_ALL_LANES));
}

__kernel void probe_offset_origin(PROBE_ITEMS, __global const ProbeSurface* surfaces,
                                  __global const Packed3* sides, __global Packed3* out) {
    PROBE_ITEM;
    Surface surface = unpack_surface(surfaces[i]);
    out[i] = pack(offset_origin(&surface, load3(sides[i])));
}

__kernel void probe_leave_surface(PROBE_ITEMS, __global const ProbeSurface* surfaces,
                                  __global const Packed3* origins, __global const Packed3* dirs,
                                  __global const Index* prims, __global ProbeRay* out) {
    PROBE_ITEM;
    Surface surface = unpack_surface(surfaces[i]);
    out[i] = pack_ray(leave_surface(&surface, load3(origins[i]), load3(dirs[i]), prims[i]));
}

// shade.cl

__kernel void probe_is_black(PROBE_ITEMS, __global const Packed3* colors, __global Index* out) {
    PROBE_ITEM;
    out[i] = is_black(load3(colors[i]));
}

__kernel void probe_specular_lobe(PROBE_ITEMS, __global const Packed3* normals,
                                  __global const Packed3* to_light, __global const Packed3* to_eye,
                                  __global const Real* shininess, __global Real* out) {
    PROBE_ITEM;
    out[i] = specular_lobe(load3(normals[i]), load3(to_light[i]), load3(to_eye[i]), shininess[i]);
}

// Light 0 of the scene; the surface says which material and, where it is one, which primitive.
__kernel void probe_light_contribution(PROBE_ITEMS, PROBE_SCENE,
                                       __global const ProbeSurface* surfaces,
                                       __global const Packed3* origins,
                                       __global const Packed3* to_eye, __global const Index* prims,
                                       __global Packed3* out, __global RayCounts* counts) {
    PROBE_ITEM;
    SceneView scene = PROBE_SCENE_VIEW;
    Surface surface = unpack_surface(surfaces[i]);
    Finish finish = probe_finish(&scene, &surface);
    PacketCounts used = {0, 0, 0};
    out[i] = pack(light_contribution(&scene, &surface, &finish, &lights[0], load3(origins[i]),
                                     load3(to_eye[i]), prims[i], RT_ALL_LANES, &used));
    counts[i] = pack_counts(used);
}

__kernel void probe_shade(PROBE_ITEMS, PROBE_SCENE, __global const ProbeSurface* surfaces,
                          __global const Packed3* to_eye, __global const Index* prims,
                          __global Packed3* out, __global RayCounts* counts) {
    PROBE_ITEM;
    SceneView scene = PROBE_SCENE_VIEW;
    Surface surface = unpack_surface(surfaces[i]);
    Finish finish = probe_finish(&scene, &surface);
    PacketCounts used = {0, 0, 0};
    out[i] =
        pack(shade(&scene, &surface, &finish, load3(to_eye[i]), prims[i], RT_ALL_LANES, &used));
    counts[i] = pack_counts(used);
}

// whitted.cl

__kernel void probe_mirror_ray(PROBE_ITEMS, __global const ProbeSurface* surfaces,
                               __global const Packed3* dirs, __global const Index* prims,
                               __global ProbeRay* out) {
    PROBE_ITEM;
    Surface surface = unpack_surface(surfaces[i]);
    out[i] = pack_ray(mirror_ray(&surface, load3(dirs[i]), prims[i]));
}

__kernel void probe_refracted_ray(PROBE_ITEMS, __global const ProbeSurface* surfaces,
                                  __global const Packed3* dirs, __global const Real* eta,
                                  __global const Index* prims, __global ProbeRay* out,
                                  __global Index* total) {
    PROBE_ITEM;
    Surface surface = unpack_surface(surfaces[i]);
    Mask is_total;
    out[i] = pack_ray(refracted_ray(&surface, load3(dirs[i]), eta[i], prims[i], &is_total));
    total[i] = is_total;
}

__kernel void probe_trace_path(PROBE_ITEMS, PROBE_SCENE, __global const ProbeRay* rays,
                               __global Packed3* out, __global RayCounts* counts) {
    PROBE_ITEM;
    SceneView scene = PROBE_SCENE_VIEW;
    PacketCounts used = {0, 0, 0};
    out[i] = pack(trace_path(&scene, unpack_ray(rays[i]), RT_ALL_LANES, &used));
    counts[i] = pack_counts(used);
}

__kernel void probe_trace_sample(PROBE_ITEMS, PROBE_SCENE, __global const Index* x,
                                 __global const Index* y, __global const Index* k,
                                 __global Packed3* out, __global RayCounts* counts) {
    PROBE_ITEM;
    SceneView scene = PROBE_SCENE_VIEW;
    PacketCounts used = {0, 0, 0};
    out[i] = pack(trace_sample(&scene, x[i], y[i], k[i], RT_ALL_LANES, &used));
    counts[i] = pack_counts(used);
}

// render.cl

__kernel void probe_store3(PROBE_ITEMS, __global const Packed3* colors, __global Packed3* out) {
    PROBE_ITEM;
    store3((__global Real*)out, (Index)i, colors[i].x, colors[i].y, colors[i].z);
}

__kernel void probe_add_counts(PROBE_ITEMS, __global const RayCounts* a,
                               __global const RayCounts* b, __global RayCounts* out) {
    PROBE_ITEM;
    out[i] = a[i];
    add_counts(out, i, b[i]);
}

// sampling.cl

__kernel void probe_reverse_bits(PROBE_ITEMS, __global const uint* v, __global uint* out) {
    PROBE_ITEM;
    out[i] = reverse_bits(v[i]);
}

__kernel void probe_swap_bits(PROBE_ITEMS, __global const uint* v, __global const uint* mask,
                              __global const uint* shift, __global uint* out) {
    PROBE_ITEM;
    out[i] = swap_bits(v[i], mask[i], shift[i]);
}

__kernel void probe_hash_bits(PROBE_ITEMS, __global const uint* v, __global uint* out) {
    PROBE_ITEM;
    out[i] = hash_bits(v[i]);
}

__kernel void probe_owen_scramble(PROBE_ITEMS, __global const uint* v, __global const uint* seed,
                                  __global uint* out) {
    PROBE_ITEM;
    out[i] = owen_scramble(v[i], seed[i]);
}

__kernel void probe_sobol_second(PROBE_ITEMS, __global const uint* index, __global uint* out) {
    PROBE_ITEM;
    out[i] = sobol_second(index[i]);
}

__kernel void probe_unit_from_bits(PROBE_ITEMS, __global const uint* bits, __global Real* out) {
    PROBE_ITEM;
    out[i] = unit_from_bits(bits[i]);
}

__kernel void probe_sobol_position(PROBE_ITEMS, __global const uint* seed, __global const uint* k,
                                   __global Real* x, __global Real* y) {
    PROBE_ITEM;
    Position position = sobol_position(seed[i], k[i]);
    x[i] = position.x;
    y[i] = position.y;
}

__kernel void probe_grid_position(PROBE_ITEMS, __global const Index* grid, __global const Index* k,
                                  __global Real* x, __global Real* y) {
    PROBE_ITEM;
    Position position = grid_position(grid[i], k[i]);
    x[i] = position.x;
    y[i] = position.y;
}

__kernel void probe_filter_radius(PROBE_ITEMS, __global const Index* filter, __global Real* out) {
    PROBE_ITEM;
    out[i] = filter_radius(filter[i]);
}

__kernel void probe_mitchell_weight(PROBE_ITEMS, __global const Real* d, __global Real* out) {
    PROBE_ITEM;
    out[i] = mitchell_weight(d[i]);
}

__kernel void probe_filter_weight(PROBE_ITEMS, __global const Index* filter, __global const Real* d,
                                  __global Real* out) {
    PROBE_ITEM;
    out[i] = filter_weight(filter[i], d[i]);
}

// unit_position, sample_position and sample_weight of one sample.
__kernel void probe_sample(PROBE_ITEMS, __global const Frame* frame, __global const Index* x,
                           __global const Index* y, __global const Index* k, __global Real* unit_x,
                           __global Real* unit_y, __global Real* sample_x, __global Real* sample_y,
                           __global Real* weight) {
    PROBE_ITEM;
    Frame f = *frame;
    Position unit = unit_position(&f, x[i], y[i], k[i]);
    Position sample = sample_position(&f, x[i], y[i], k[i]);
    unit_x[i] = unit.x;
    unit_y[i] = unit.y;
    sample_x[i] = sample.x;
    sample_y[i] = sample.y;
    weight[i] = sample_weight(&f, x[i], y[i], k[i]);
}

__kernel void probe_trace_pixel(PROBE_ITEMS, PROBE_SCENE, __global const Index* x,
                                __global const Index* y, __global Packed3* out) {
    PROBE_ITEM;
    SceneView scene = PROBE_SCENE_VIEW;
    RayCounts counts = {0, 0, 0};
    Packet packet = make_packet(frame->samples, RT_SAMPLES_TOGETHER);
    out[i] = pack(trace_pixels(&scene, &packet, x[i], y[i], RT_ALL_LANES, &counts));
}
