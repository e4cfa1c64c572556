// SPDX-License-Identifier: Apache-2.0
//
// From a hit to a point on the surface and its normals.
//
// A triangle's point is its barycentric combination, 10 to 10^5 times nearer to the plane than
// origin + t dir; except on triangles much larger than the distance, where origin + t dir projected
// onto the plane is nearer. A sphere's point is moved to distance r from the center, a cone's to
// its radius from the axis. Each point carries a bound on its distance from the surface.
#ifndef RT_SURFACE_CL
#define RT_SURFACE_CL

#include "kernels/cone.cl"
#include "kernels/scene_view.h"

typedef struct {
    real3 point;
    real3 point_low;  // spheres: the part of point lost to rounding; else 0
    real3 normal;     // shading normal, unit: interpolated where the triangle has vertex normals
    real3 geometric;  // geometric normal, unit, on the shading normal's side
    Reals offset;     // bound on the distance between point and surface
    // A sphere's diameter, and its analog on a cone: the length of the gradient of the implicit
    // function. Positive where the geometric normal points outwards; 0 on triangles.
    Reals signed_diameter;
    Reals back;  // how far surface_at has moved the point back along the ray; else 0
    Indices material;
} Surface;

// The normal where the ray meets the sphere at t, from the closest approach and the half chord. The
// low parts of the ray and of the center are added where only lengths of about the radius are left,
// so that small, distant spheres keep accurate normals, and mirror rays between them their paths.
real3 sphere_normal(const Ray* ray, Reals t, __global const Sphere* sphere) {
    real3 f = sub3(ray->origin, load3(sphere->center));
    Reals b = -dot3(f, ray->dir);
    real3 l = add_scaled(f, b, ray->dir);
    l = add_scaled(add3(ray->origin_low, l), t, ray->dir_low);
    l = sub3(l, load3(sphere->center_low));
    l = add_scaled(l, -dot3(l, ray->dir), ray->dir);
    Reals squared = (Reals)(sphere->radius * sphere->radius) - dot3(l, l);
    Reals s = squared > (Reals)0 ? sqrt(squared) : (Reals)0;
    return normalize3(add_scaled(l, t < b ? -s : s, ray->dir));
}

Surface sphere_surface(const Ray* ray, Reals t, __global const Sphere* sphere) {
    real3 center = load3(sphere->center);
    Surface surface;
    surface.normal = sphere_normal(ray, t, sphere);
    surface.geometric = surface.normal;
    real3 out = add_scaled(load3(sphere->center_low), (Reals)sphere->radius, surface.normal);
    surface.point = add3(center, out);
    surface.point_low = add3(sub3(center, surface.point), out);
    Reals spread = dot3(abs3(surface.normal), add3(abs3(center), abs3(surface.point)));
    surface.offset = (Real)RT_ROUNDOFF * fma((Reals)5, (Reals)sphere->radius, spread);
    if (RT_HAS(HUGE_SPHERES) && sphere->is_huge != 0) {
        surface.point = add_scaled(ray->origin, t, ray->dir);
        surface.point_low = make3((Reals)0, (Reals)0, (Reals)0);
        surface.normal = normalize3(sub3(surface.point, center));
        surface.geometric = surface.normal;
        real3 error =
            add_scaled(scale3((Reals)4, abs3(ray->origin)), (Reals)6, abs3(surface.point));
        surface.offset = (Real)RT_ROUNDOFF * dot3(abs3(surface.normal), error);
    }
    surface.signed_diameter = (Reals)((Real)2 * sphere->radius);
    surface.material = (Indices)sphere->material;
    return surface;
}

// The point is moved onto the cone at its height, on a flat cone at its radius; on the axis, where
// the radius is 0, the normal faces the viewer.
Surface cone_surface(const Ray* ray, Reals t, __global const Cone* cone) {
    real3 base = load3(cone->base);
    real3 axis = load3(cone->axis);
    real3 along = add_scaled(sub3(ray->origin, base), t, ray->dir);
    Reals height = min_of(max_of(dot3(along, axis), (Reals)0), (Reals)cone->length);
    real3 outwards = add_scaled(along, -height, axis);
    Reals squared = dot3(outwards, outwards);
    Reals radius = max_of(fma((Reals)cone->slope, height, (Reals)cone->base_radius), (Reals)0);
    if (is_flat(cone)) {
        Real rim = cone->base_radius, other_rim = cone->apex_radius;
        Reals least = (Reals)(rim < other_rim ? rim : other_rim);
        Reals most = (Reals)(rim < other_rim ? other_rim : rim);
        radius = min_of(max_of(sqrt(squared), least), most);
        height = (radius - (Reals)rim) / (Reals)cone->slope;
    }
    outwards = scale3((Reals)1 / sqrt(squared), outwards);
    Mask is_on_axis = !(squared > (Reals)0);
    Surface surface;
    surface.normal = normalize3(add_scaled(outwards, -(Reals)cone->slope, axis));
    surface.normal = select3(is_on_axis, negate3(ray->dir), surface.normal);
    surface.geometric = surface.normal;
    real3 center = add_scaled(base, height, axis);
    real3 point = add_scaled(center, radius, outwards);
    surface.point = select3(is_on_axis, center, point);
    surface.point_low = make3((Reals)0, (Reals)0, (Reals)0);
    real3 size = add3(abs3(center), abs3(surface.point));
    Reals extent =
        (Real)8 * fma(fabs((Reals)cone->slope), (Reals)cone->length, (Reals)cone->base_radius);
    surface.offset = (Real)RT_ROUNDOFF * (dot3(abs3(surface.normal), size) + extent);
    surface.signed_diameter =
        (Real)2 * radius * sqrt(fma((Reals)cone->slope, (Reals)cone->slope, (Reals)1));
    surface.material = (Indices)cone->material;
    return surface;
}

// The normal interpolated from the vertices, or the face normal where the interpolation vanishes.
real3 blended_normal(__global const VertexNormals* normals, real3 face, Reals u, Reals v) {
    real3 blend = scale3((Reals)1 - u - v, load3(normals->n0));
    blend = add_scaled(blend, u, load3(normals->n1));
    blend = add_scaled(blend, v, load3(normals->n2));
    Reals squared = dot3(blend, blend);
    return select3(squared > (Reals)0x1p-40f, scale3((Reals)1 / sqrt(squared), blend), face);
}

// Not fmax, which PoCL compiles to many instructions.
Real larger_of(Real a, Real b) { return a > b ? a : b; }

Real largest_of(Packed3 p) { return larger_of(larger_of(fabs(p.x), fabs(p.y)), fabs(p.z)); }

Real largest_coordinate(__global const Triangle* triangle) {
    return larger_of(larger_of(largest_of(triangle->p0), largest_of(triangle->p1)),
                     largest_of(triangle->p2));
}

Surface triangle_surface(const Ray* ray, const Hit* hit, __global const Triangle* triangle,
                         __global const VertexNormals* vertex_normals) {
    real3 normal = load3(triangle->normal);
    real3 p0 = load3(triangle->p0);
    Surface surface;
    surface.point = add_scaled(p0, hit->u, sub3(load3(triangle->p1), p0));
    surface.point = add_scaled(surface.point, hit->v, sub3(load3(triangle->p2), p0));
    surface.point_low = make3((Reals)0, (Reals)0, (Reals)0);
    surface.offset = (Reals)triangle->offset;
    Reals distance = length3(ray->origin) + hit->t;
    Mask is_large = largest_coordinate(triangle) > (Reals)8 * distance;
    if (any_lane(is_large)) {
        real3 along = add_scaled(ray->origin, hit->t, ray->dir);
        real3 projected = add_scaled(along, triangle->plane - dot3(normal, along), normal);
        surface.point = select3(is_large, projected, surface.point);
        surface.offset =
            is_large ? (Reals)((Real)16 * (Real)RT_ROUNDOFF) * distance : surface.offset;
    }
    surface.normal = normal;
    surface.geometric = normal;
    surface.signed_diameter = (Reals)0;
    surface.material = (Indices)triangle->material;
    if (RT_HAS(VERTEX_NORMALS) && triangle->smooth != RT_NONE) {
        __global const VertexNormals* normals = &vertex_normals[triangle->smooth];
        surface.normal = blended_normal(normals, normal, hit->u, hit->v);
        Mask turned = dot3(surface.normal, normal) < (Reals)0;
        surface.geometric = select3(turned, negate3(normal), normal);
    }
    return surface;
}

#endif
