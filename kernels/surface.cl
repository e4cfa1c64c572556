// SPDX-License-Identifier: Apache-2.0
//
// From a hit to a point on the surface, its normals, and where a further ray may start.
//
// A triangle's point is its barycentric combination, 10 to 10^5 times nearer to the plane than
// origin + t dir; except on triangles much larger than the distance, where origin + t dir projected
// onto the plane is nearer. A sphere's point is put back at distance r from the centre. Each point
// carries a bound on how far it may lie off its surface; secondary rays start that far out along
// the geometric normal and one ulp further (after Pharr, Jakob and Humphreys, PBR 4th ed., 6.8).
//
// Where the ray met several surfaces at once, or a triangle within rounding of its edge, that
// offset clears only one of them, and whether the neighbour is in the way would be decided by
// rounding. There the point moves eight offsets back along the ray, to the viewer's side of all of
// them.
#ifndef RT_SURFACE_CL
#define RT_SURFACE_CL

#include "kernels/bits.cl"
#include "kernels/math.cl"
#include "kernels/scene_view.h"

typedef struct {
    real3 point;
    real3 normal;     // shading normal, unit: interpolated where the triangle has vertex normals
    real3 geometric;  // geometric normal, unit, on the shading normal's side
    Real offset;      // bound on the distance between point and surface
    Index material;
} Surface;

Surface sphere_surface(const Ray* ray, Real t, __global const Sphere* sphere) {
    real3 center = load3(sphere->center);
    Surface surface;
    surface.normal = normalize3(add_scaled(sub3(ray->origin, center), t, ray->dir));
    surface.geometric = surface.normal;
    surface.point = add_scaled(center, sphere->radius, surface.normal);
    Real spread = dot3(abs3(surface.normal), abs3(surface.point));
    surface.offset = (Real)RT_ROUNDOFF * fma((Real)5, sphere->radius, spread);
    surface.material = sphere->material;
    return surface;
}

// The normal blended from the vertices, or the face's own where the blend vanishes.
real3 blended_normal(__global const VertexNormals* normals, real3 face, Real u, Real v) {
    real3 blend = scale3((Real)1 - u - v, load3(normals->n0));
    blend = add_scaled(blend, u, load3(normals->n1));
    blend = add_scaled(blend, v, load3(normals->n2));
    Real squared = dot3(blend, blend);
    return squared > (Real)1e-12 ? scale3((Real)1 / sqrt(squared), blend) : face;
}

Surface triangle_surface(const Ray* ray, const Hit* hit, __global const Triangle* triangle,
                         __global const VertexNormals* vertex_normals) {
    real3 normal = load3(triangle->normal);
    real3 p0 = load3(triangle->p0);
    Surface surface;
    surface.point = add_scaled(p0, hit->u, sub3(load3(triangle->p1), p0));
    surface.point = add_scaled(surface.point, hit->v, sub3(load3(triangle->p2), p0));
    surface.offset = triangle->offset;
    Real reach = (Real)RT_ROUNDOFF * (length3(ray->origin) + hit->t);
    if (triangle->offset > (Real)64 * reach) {
        real3 along = add_scaled(ray->origin, hit->t, ray->dir);
        surface.point = add_scaled(along, triangle->plane - dot3(normal, along), normal);
        surface.offset = (Real)16 * reach;
    }
    surface.normal = normal;
    surface.geometric = normal;
    surface.material = triangle->material;
    if (RT_HAS_VERTEX_NORMALS && triangle->smooth != RT_NONE) {
        __global const VertexNormals* normals = &vertex_normals[triangle->smooth];
        surface.normal = blended_normal(normals, normal, hit->u, hit->v);
        if (dot3(surface.normal, normal) < (Real)0) surface.geometric = negate3(normal);
    }
    return surface;
}

Surface primitive_surface(const SceneView* scene, const Ray* ray, const Hit* hit) {
    if (RT_HAS_SPHERES && hit->prim < scene->frame.sphere_count) {
        return sphere_surface(ray, hit->t, &scene->spheres[hit->prim]);
    }
    Index index = hit->prim - scene->frame.sphere_count;
    return triangle_surface(ray, hit, &scene->triangles[index], scene->vertex_normals);
}

// Whether a triangle was hit within rounding of its edge, where a neighbour may begin.
bool is_on_edge(const SceneView* scene, const Hit* hit) {
    if (hit->prim < scene->frame.sphere_count) return false;
    Real rim = (Real)64 * (Real)RT_ROUNDOFF;
    return hit->u < rim || hit->v < rim || (Real)1 - hit->u - hit->v < rim;
}

// The hit's surface, its point moved clear of the other surfaces it touches.
Surface surface_at(const SceneView* scene, const Ray* ray, const Hit* hit) {
    Surface surface = primitive_surface(scene, ray, hit);
    if (hit->tied != 0 || is_on_edge(scene, hit)) {
        surface.point = add_scaled(surface.point, (Real)-8 * surface.offset, ray->dir);
    }
    return surface;
}

// Where a ray starts that leaves the surface on the side that `side` points to.
real3 offset_origin(const Surface* surface, real3 side) {
    Real distance = dot3(surface->geometric, side) < (Real)0 ? -surface->offset : surface->offset;
    real3 step = scale3(distance, surface->geometric);
    real3 p = add3(surface->point, step);
    return make3(one_ulp_towards(p.x, step.x), one_ulp_towards(p.y, step.y),
                 one_ulp_towards(p.z, step.z));
}

#endif
