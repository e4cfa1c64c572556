// SPDX-License-Identifier: Apache-2.0
//
// One ray against one primitive. No absolute epsilon anywhere.
//
// Spheres: the discriminant comes from the point of closest approach, D = r^2 - |f + b d|^2, which
// keeps small distant spheres accurate (Haines, Gunther and Akenine-Moller, Ray Tracing Gems 7). A
// ray that starts on a sphere carries its chord through it, computed from the normal there: on a
// small sphere far from the eye, origin - center has lost the digits that matter.
//
// Triangles: sheared into the ray's frame (Woop, Benthin and Wald 2013), the three edge functions
// by difference_of_products. Each depends only on two vertices and the ray and has the correct
// sign, so neighbors agree on a shared edge: nothing leaks, whatever the compiler contracts. A ray
// through a shared edge hits both neighbors; closest_hit settles the tie. The distance is the
// vertices' mean weighted by the edge functions; on a triangle much larger than the distance that
// would be a small difference of large numbers, so there it comes from the plane.
#ifndef RT_INTERSECT_CL
#define RT_INTERSECT_CL

#include "kernels/math.cl"
#include "kernels/scene_view.h"

// A huge sphere, by the constant term of its quadratic, |origin|^2 - 2 origin.center + power. The
// host computes the power, |center|^2 - radius^2, in double; near the surface, origin - center
// would round away the height above it.
Mask intersect_huge_sphere(const Ray* ray, __global const Sphere* sphere, Reals* t) {
    real3 center = load3(sphere->center);
    Reals squared_radius = (Reals)(sphere->radius * sphere->radius);
    Reals c = (dot3(ray->origin, ray->origin) - (Reals)2 * dot3(ray->origin, center)) +
              (Reals)sphere->power;
    real3 f = sub3(ray->origin, center);
    Reals b = -dot3(f, ray->dir);
    real3 l = add_scaled(f, b, ray->dir);
    Reals discriminant = squared_radius > b * b ? fma(b, b, -c) : squared_radius - dot3(l, l);
    Reals s = sqrt(discriminant);
    Reals q = b < (Reals)0 ? b - s : b + s;
    Reals other = q == (Reals)0 ? q : c / q;
    Reals near = min_of(q, other);
    *t = near > (Reals)0 ? near : max_of(q, other);
    return discriminant >= (Reals)0;
}

// Where the eye lies on or next to a surface: RT_ON, RT_OUTSIDE, RT_INSIDE; 0: elsewhere.
Index eye_side(Index touches) { return RT_HAS(EYE_ON_SURFACE) ? touches & RT_ON : 0; }

// Whether rays from an eye this close to a surface meet it at once: `outwards` those that go from
// its inside to its outside.
Mask starts_through(Index side, Mask outwards) {
    return side == RT_INSIDE ? outwards : (side == RT_OUTSIDE ? !outwards : RT_NO_LANES);
}

// The lanes whose rays start on the sphere, and their chords through it.
Mask leaves_sphere(const Ray* ray, __global const Sphere* sphere, Index prim, Reals* chord) {
    Mask leaving = ray->from == prim;
    *chord = ray->self_hit;
    Index side = eye_side(sphere->touches);
    if (side != 0) {
        Mask from_eye = ray->from == RT_EYE;
        Reals inward = (Reals)2 * dot3(load3(sphere->center), ray->dir);
        Mask at_once = starts_through(side, inward < (Reals)0);
        inward = at_once ? (Reals)((Real)RT_ROUNDOFF * sphere->radius) : inward;
        *chord = from_eye ? inward : *chord;
        leaving |= from_eye;
    }
    return leaving;
}

// Whether the rays' lines meet sphere number prim, and at which distance t: the nearer one in front
// of the origin, else the farther one. For rays that start on it, the far end of the chord.
Mask intersect_sphere(const Ray* ray, __global const Sphere* sphere, Index prim, Reals* t) {
    Reals chord;
    Mask leaving = leaves_sphere(ray, sphere, prim, &chord);
    if (RT_HAS(HUGE_SPHERES) && sphere->is_huge != 0) {
        Mask met = intersect_huge_sphere(ray, sphere, t);
        *t = leaving ? chord : *t;
        return met | leaving;
    }
    real3 f = sub3(ray->origin, load3(sphere->center));
    Reals b = -dot3(f, ray->dir);
    real3 l = add_scaled(f, b, ray->dir);
    Reals discriminant = (Reals)(sphere->radius * sphere->radius) - dot3(l, l);
    Mask met = discriminant >= (Reals)0;
    met |= leaving;
    *t = b;
    if (!any_lane(met)) return met;
    Reals s = sqrt(discriminant);
    Reals near = b - s;
    Reals nearest = near > (Reals)0 ? near : b + s;
    *t = leaving ? chord : nearest;
    return met;
}

// Where the light with this place in the bits lies on or next to a surface; likewise.
Index light_side(Index touches, Index place) { return (touches >> place) & RT_ON; }

// Whether a shadow ray that crosses a surface at t does so before the light at t_max. Where the
// light lies on the surface or next to it (`side`), rounding cannot tell: then the crossing nearest
// to the light counts if it leads from the other side to the light's. (Where the light is inside,
// it lies between both, and the first counts.) The rounding error of a root grows as the square
// root of roundoff where the ray grazes the surface, whose size is `size`.
Mask is_before_light(Reals t, Mask outwards, Mask is_nearest, Index side, Reals t_max, Real size) {
    Reals away = t - t_max;
    Reals reach = t_max + size;
    Mask near = away * away <= (Reals)((Real)64 * (Real)RT_ROUNDOFF) * reach * reach;
    if (side == RT_INSIDE) return near ? !outwards : t <= t_max;
    Mask crosses = side == RT_OUTSIDE ? outwards : RT_NO_LANES;
    return near & is_nearest ? crosses : t <= t_max;
}

// Whether shadow rays meet the sphere, at t where `met`, before the light. To a light inside they
// do, next to the light, even where rounding has them pass by.
Mask meets_sphere_before(const Ray* ray, __global const Sphere* sphere, Mask met, Reals t,
                         Reals t_max, Index side) {
    Reals middle = dot3(sub3(load3(sphere->center), ray->origin), ray->dir);
    Mask outwards = met & (t >= middle);
    t = met ? t : (side == RT_INSIDE ? t_max : (Reals)INFINITY);
    Mask is_nearest = outwards | (t_max < middle);
    return (t > (Reals)0) & is_before_light(t, outwards, is_nearest, side, t_max, sphere->radius);
}

// The rays' frames: z is the direction's largest component, x and y the next two in order.
typedef struct {
    real3 origin;  // its components in that order
    Reals sx, sy, sz;
    Indices axis;       // the scene axis used as z
    Index common_axis;  // that of all live rays, or RT_NONE
} RayShear;

Reals component3(real3 v, Indices k) {
    return k == (Indices)0 ? v.x : (k == (Indices)1 ? v.y : v.z);
}

Indices next_axis(Indices k) { return k == (Indices)2 ? (Indices)0 : k + 1; }

Indices largest_axis(real3 v) {
    real3 a = abs3(v);
    Indices y_or_z = a.y > a.z ? (Indices)1 : (Indices)2;
    Indices x_or_z = a.x > a.z ? (Indices)0 : (Indices)2;
    return a.x > a.y ? x_or_z : y_or_z;
}

Index common_axis(Indices axis, Mask live) {
#if RT_LANES == 1
    return axis;
#else
    if (!any_lane(live & (axis != 0))) return 0;
    if (!any_lane(live & (axis != 1))) return 1;
    return any_lane(live & (axis != 2)) ? RT_NONE : 2;
#endif
}

// v's components, reordered so that axis z comes last.
real3 in_frame(real3 v, Indices z) {
    Indices x = next_axis(z);
    return make3(component3(v, x), component3(v, next_axis(x)), component3(v, z));
}

// Likewise, where all rays have the same axis.
real3 in_one_frame(real3 v, Index z) {
    if (z == 2) return v;
    return z == 0 ? make3(v.y, v.z, v.x) : make3(v.z, v.x, v.y);
}

// A point or normal of the scene in the rays' frames. Where these are one, its components are
// picked as they are loaded.
real3 load_in_frame(const RayShear* shear, __global const Packed3* v) {
    Index z = shear->common_axis;
    if (RT_LANES != 1 && z == RT_NONE) return in_frame(load3(*v), shear->axis);
    __global const Real* p = &v->x;
    Index x = z == 2 ? 0 : z + 1;
    Index y = x == 2 ? 0 : x + 1;
    return make3((Reals)p[x], (Reals)p[y], (Reals)p[z]);
}

RayShear make_shear(const Ray* ray, Mask live) {
    RayShear shear;
    shear.axis = largest_axis(ray->dir);
    shear.common_axis = common_axis(shear.axis, live);
    real3 dir;
    if (RT_LANES != 1 && shear.common_axis != RT_NONE) {
        shear.origin = in_one_frame(ray->origin, shear.common_axis);
        dir = in_one_frame(ray->dir, shear.common_axis);
    } else {
        shear.origin = in_frame(ray->origin, shear.axis);
        dir = in_frame(ray->dir, shear.axis);
    }
    shear.sz = (Reals)1 / dir.z;
    shear.sx = dir.x * shear.sz;
    shear.sy = dir.y * shear.sz;
    return shear;
}

// The vertex in the rays' frames.
real3 shear_vertex(const RayShear* shear, __global const Packed3* vertex) {
    real3 p = sub3(load_in_frame(shear, vertex), shear->origin);
    return make3(fma(-shear->sx, p.z, p.x), fma(-shear->sy, p.z, p.y), p.z);
}

// Distance along the rays to the triangle's plane; NaN or infinite if parallel to it. 0 for rays
// that start within rounding of the plane: where it says that they cross is noise.
Reals plane_distance(const RayShear* shear, __global const Triangle* triangle) {
    real3 n = load_in_frame(shear, &triangle->normal);
    real3 o = shear->origin;
    Reals height = triangle->plane - fma(n.z, o.z, fma(n.y, o.y, n.x * o.x));
    Reals slope = fma(n.x, shear->sx, fma(n.y, shear->sy, n.z));
    Reals error = (Real)(2 * RT_ROUNDOFF) * (fabs(n.x * o.x) + fabs(n.y * o.y) + fabs(n.z * o.z));
    return fabs(height) <= error ? (Reals)0 : height * shear->sz / slope;
}

// Whether the rays' lines meet the triangle, at which distance t, and the barycentric coordinates u
// and v of its second and third vertex there.
Mask intersect_triangle(const RayShear* shear, __global const Triangle* triangle, Reals* t,
                        Reals* u, Reals* v) {
    real3 a = shear_vertex(shear, &triangle->p0);
    real3 b = shear_vertex(shear, &triangle->p1);
    real3 c = shear_vertex(shear, &triangle->p2);
    Reals wa = difference_of_products(c.x, b.y, c.y, b.x);
    Reals wb = difference_of_products(a.x, c.y, a.y, c.x);
    Reals wc = difference_of_products(b.x, a.y, b.y, a.x);
    Mask front = min_of(wa, min_of(wb, wc)) >= (Reals)0;
    Mask back = max_of(wa, max_of(wb, wc)) <= (Reals)0;
    Mask inside = front | back;
    if (!any_lane(inside)) return inside;
    Reals determinant = wa + wb + wc;
    Reals inverse = (Reals)1 / determinant;
    *u = wb * inverse;
    *v = wc * inverse;
    *t = fma(wa, a.z, fma(wb, b.z, wc * c.z)) * shear->sz * inverse;
    inside &= determinant != (Reals)0;
    Reals reach = max_of(max_of(fabs(a.z), fabs(b.z)), fabs(c.z)) * fabs(shear->sz);
    // *t overflows where the vertices are beyond the cube root of the largest number.
    Mask is_far = inside & ((reach > (Reals)8 * fabs(*t)) | !(fabs(*t) < (Reals)INFINITY));
    if (any_lane(is_far)) *t = is_far ? plane_distance(shear, triangle) : *t;
    return inside;
}

#endif
