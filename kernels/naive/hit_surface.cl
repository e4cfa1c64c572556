// SPDX-License-Identifier: Apache-2.0
//
// Points at origin + t dir, not put back on their surface; further rays from 1e-4 off it, which
// carry neither its number nor a chord; no point moved clear of a neighbour.
#ifndef RT_NAIVE_HIT_SURFACE_CL
#define RT_NAIVE_HIT_SURFACE_CL

#include "kernels/naive/intersect.cl"

#if RT_NAIVE_POINTS
#define sphere_surface robust_sphere_surface
#define triangle_surface robust_triangle_surface
#endif
#include "kernels/surface.cl"
#undef sphere_surface
#undef triangle_surface

#if RT_NAIVE_POINTS
Surface sphere_surface(const Ray* ray, Reals t, __global const Sphere* sphere) {
    Surface surface;
    surface.point = add_scaled(ray->origin, t, ray->dir);
    surface.point_low = make3((Reals)0, (Reals)0, (Reals)0);
    surface.normal =
        scale3((Reals)((Real)1 / sphere->radius), sub3(surface.point, load3(sphere->center)));
    surface.geometric = surface.normal;
    Reals spread = dot3(abs3(surface.normal), abs3(surface.point));
    surface.offset = (Real)RT_ROUNDOFF * fma((Reals)5, (Reals)sphere->radius, spread);
    surface.diameter = (Reals)((Real)2 * sphere->radius);
    surface.material = (Indices)sphere->material;
    return surface;
}

Surface triangle_surface(const Ray* ray, const Hit* hit, __global const Triangle* triangle,
                         __global const VertexNormals* vertex_normals) {
    Surface surface;
    surface.point = add_scaled(ray->origin, hit->t, ray->dir);
    surface.point_low = make3((Reals)0, (Reals)0, (Reals)0);
    surface.normal = load3(triangle->normal);
    surface.geometric = surface.normal;
    surface.offset = (Reals)triangle->offset;
    surface.diameter = (Reals)0;
    surface.material = (Indices)triangle->material;
    if (RT_HAS_VERTEX_NORMALS && triangle->smooth != RT_NONE) {
        __global const VertexNormals* normals = &vertex_normals[triangle->smooth];
        surface.normal = blended_normal(normals, surface.normal, hit->u, hit->v);
        Mask turned = dot3(surface.normal, surface.geometric) < (Reals)0;
        surface.geometric = select3(turned, negate3(surface.geometric), surface.geometric);
    }
    return surface;
}
#endif

#if RT_NAIVE_TIES
#define surface_at robust_surface_at
#endif
#if RT_NAIVE_OFFSETS
#define offset_origin robust_offset_origin
#define leave_surface robust_leave_surface
#endif
#include "kernels/hit_surface.cl"
#undef surface_at
#undef offset_origin
#undef leave_surface

#if RT_NAIVE_TIES
Surface surface_at(const SceneView* scene, const Ray* ray, const Hit* hit, Mask live) {
    return hit_surface(scene, ray, hit, live);
}
#endif

#if RT_NAIVE_OFFSETS
real3 offset_origin(const Surface* surface, real3 side) {
    Mask behind = dot3(surface->geometric, side) < (Reals)0;
    Reals distance = behind ? (Reals)-1e-4f : (Reals)1e-4f;
    return add_scaled(surface->point, distance, surface->geometric);
}

Ray leave_surface(const Surface* surface, real3 origin, real3 dir, Indices prim) {
    Ray ray;
    ray.origin = origin;
    ray.dir = dir;
    ray.dir_low = ray.origin_low = make3((Reals)0, (Reals)0, (Reals)0);
    ray.t_max = (Reals)INFINITY;
    ray.chord = (Reals)0;
    ray.from = (Indices)RT_NONE;
    return ray;
}
#endif

#endif
