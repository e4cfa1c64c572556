// SPDX-License-Identifier: Apache-2.0
//
// One ray against one primitive. No absolute epsilon anywhere.
//
// Spheres: the discriminant comes from the point of closest approach, D = r^2 - |f + b d|^2, which
// keeps small distant spheres (Haines, Gunther and Akenine-Moller, Ray Tracing Gems 7). A ray that
// leaves the sphere it starts on solves the equation with c = 0, exactly.
//
// Triangles: sheared into the ray's frame (Woop, Benthin and Wald 2013), the three edge functions
// by difference_of_products. They depend on two vertices and the ray alone and their signs are
// right, so neighbours agree about a shared edge: nothing leaks, whatever the compiler contracts. A
// ray through a shared edge hits both neighbours; closest_hit settles the tie.
#ifndef RT_INTERSECT_CL
#define RT_INTERSECT_CL

#include "kernels/math.cl"
#include "kernels/scene_view.h"

// Distance along the ray to the sphere, or -1. `leaving`: the origin lies on this very sphere.
Real intersect_sphere(const Ray* ray, real3 center, Real radius, bool leaving) {
    real3 f = sub3(ray->origin, center);
    Real b = -dot3(f, ray->dir);
    if (leaving) return (Real)2 * b;
    real3 l = add_scaled(f, b, ray->dir);
    Real discriminant = radius * radius - dot3(l, l);
    if (!(discriminant >= (Real)0)) return (Real)-1;
    Real s = sqrt(discriminant);
    Real near = b - s;
    return near > (Real)0 ? near : b + s;
}

// The ray's frame: axis z is where its direction is largest, x and y the next two in turn.
typedef struct {
    Index kx, ky, kz;
    Real origin_x, origin_y, origin_z;
    Real sx, sy, sz;
} RayShear;

Real component3(real3 v, Index k) { return k == 0 ? v.x : (k == 1 ? v.y : v.z); }

RayShear make_shear(const Ray* ray) {
    real3 a = abs3(ray->dir);
    RayShear shear;
    shear.kz = a.x > a.y ? (a.x > a.z ? 0 : 2) : (a.y > a.z ? 1 : 2);
    shear.kx = shear.kz == 2 ? 0 : shear.kz + 1;
    shear.ky = shear.kx == 2 ? 0 : shear.kx + 1;
    shear.origin_x = component3(ray->origin, shear.kx);
    shear.origin_y = component3(ray->origin, shear.ky);
    shear.origin_z = component3(ray->origin, shear.kz);
    shear.sz = (Real)1 / component3(ray->dir, shear.kz);
    shear.sx = component3(ray->dir, shear.kx) * shear.sz;
    shear.sy = component3(ray->dir, shear.ky) * shear.sz;
    return shear;
}

// The vertex in the ray's frame. Its components are picked as they are loaded.
real3 shear_vertex(const RayShear* shear, __global const Packed3* vertex) {
    __global const Real* p = &vertex->x;
    Real z = p[shear->kz] - shear->origin_z;
    return make3(fma(-shear->sx, z, p[shear->kx] - shear->origin_x),
                 fma(-shear->sy, z, p[shear->ky] - shear->origin_y), z);
}

// Distance along the ray to the triangle, or -1; u and v are set on a hit.
Real intersect_triangle(const RayShear* shear, __global const Triangle* triangle, Real* u,
                        Real* v) {
    real3 a = shear_vertex(shear, &triangle->p0);
    real3 b = shear_vertex(shear, &triangle->p1);
    real3 c = shear_vertex(shear, &triangle->p2);
    Real wa = difference_of_products(c.x, b.y, c.y, b.x);
    Real wb = difference_of_products(a.x, c.y, a.y, c.x);
    Real wc = difference_of_products(b.x, a.y, b.y, a.x);
    if ((wa < 0 || wb < 0 || wc < 0) && (wa > 0 || wb > 0 || wc > 0)) return (Real)-1;
    Real determinant = wa + wb + wc;
    if (determinant == (Real)0) return (Real)-1;
    Real inverse = (Real)1 / determinant;
    *u = wb * inverse;
    *v = wc * inverse;
    return fma(wa, a.z, fma(wb, b.z, wc * c.z)) * shear->sz * inverse;
}

#endif
