// SPDX-License-Identifier: Apache-2.0
//
// Spheres by the quadratic formula; triangles after Moller and Trumbore (1997) with an absolute
// bound on the determinant; shadow rays that ask nothing about the sphere they end on.
#ifndef RT_NAIVE_INTERSECT_CL
#define RT_NAIVE_INTERSECT_CL

#include "kernels/naive/techniques.h"

#if RT_NAIVE_SPHERES
#define intersect_sphere robust_intersect_sphere
#endif
#if RT_NAIVE_TRIANGLES
#define make_shear robust_make_shear
#define intersect_triangle robust_intersect_triangle
#endif
#if RT_NAIVE_OFFSETS
#define ends_on_sphere robust_ends_on_sphere
#endif
#include "kernels/intersect.cl"
#undef intersect_sphere
#undef make_shear
#undef intersect_triangle
#undef ends_on_sphere

#if RT_NAIVE_SPHERES
Mask intersect_sphere(const Ray* ray, __global const Sphere* sphere, Index prim, Reals* t) {
    real3 f = sub3(ray->origin, load3(sphere->center));
    Reals b = (Reals)2 * dot3(f, ray->dir);
    Reals c = dot3(f, f) - (Reals)(sphere->radius * sphere->radius);
    Reals discriminant = b * b - (Reals)4 * c;
    Mask met = discriminant >= (Reals)0;
    Reals chord = (Reals)0;
    Mask leaving = RT_NO_LANES;
    if (!RT_NAIVE_OFFSETS) leaving = leaves_sphere(ray, sphere, prim, &chord);
    met |= leaving;
    if (!any_lane(met)) return met;
    Reals root = sqrt(discriminant);
    Reals near = (-b - root) * (Reals)0.5;
    Reals nearest = near > (Reals)0 ? near : (root - b) * (Reals)0.5;
    *t = leaving ? chord : nearest;
    return met;
}
#endif

#if RT_NAIVE_TRIANGLES
// The ray itself in place of its frame: the direction is (sx, sy, sz), and there is one axis.
RayShear make_shear(const Ray* ray, Mask live) {
    RayShear shear;
    shear.origin = ray->origin;
    shear.sx = ray->dir.x;
    shear.sy = ray->dir.y;
    shear.sz = ray->dir.z;
    shear.axis = (Indices)0;
    shear.axes = 1;
    return shear;
}

real3 naive_edge(Packed3 from, Packed3 to) {
    return make3((Reals)(to.x - from.x), (Reals)(to.y - from.y), (Reals)(to.z - from.z));
}

real3 naive_cross3(real3 a, real3 b) {
    return make3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

Mask intersect_triangle(const RayShear* shear, Index z, __global const Triangle* triangle, Reals* t,
                        Reals* u, Reals* v) {
    real3 dir = make3(shear->sx, shear->sy, shear->sz);
    real3 edge1 = naive_edge(triangle->p0, triangle->p1);
    real3 edge2 = naive_edge(triangle->p0, triangle->p2);
    real3 p = naive_cross3(dir, edge2);
    Reals determinant = dot3(edge1, p);
    Reals inverse = (Reals)1 / determinant;
    real3 s = sub3(shear->origin, load3(triangle->p0));
    *u = dot3(s, p) * inverse;
    Mask met = (fabs(determinant) >= (Reals)1e-8f) & (*u >= (Reals)0) & (*u <= (Reals)1);
    if (!any_lane(met)) return met;
    real3 q = naive_cross3(s, edge1);
    *v = dot3(dir, q) * inverse;
    met &= (*v >= (Reals)0) & (*u + *v <= (Reals)1);
    if (!any_lane(met)) return met;
    *t = dot3(edge2, q) * inverse;
    return met;
}
#endif

#if RT_NAIVE_OFFSETS
Mask ends_on_sphere(const Ray* ray, __global const Sphere* sphere, Reals t, Reals t_max) {
    return RT_NO_LANES;
}
#endif

#endif
