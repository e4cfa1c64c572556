// SPDX-License-Identifier: Apache-2.0
//
// Rays against the side of a cone's frustum, open at both ends; a cylinder has slope 0.
//
// With w from the base to the ray's origin, g = w x axis and c = dir x axis are the components
// across the axis, turned by 90 degrees, and a point at t lies on the (double) cone where |g + t c|
// = |R + m t|, R being the radius at the origin's height and m = slope (dir.axis). The cross
// products use differences of products, hence keep their digits when the ray runs along the axis.
//
// The origin is first moved to the ray's closest approach to the axis, or as near to it as the
// frustum reaches, so that nothing much larger than the frustum is ever subtracted. The
// discriminant is |R c - m g|^2 - |g x c|^2: its only subtraction is the one that decides hit or
// miss (for a cylinder it is P (R^2 - l^2) with l the ray's distance from the axis). The equation
// is solved without cancellation, and a root counts if its height is on the frustum and the radius
// there is not negative, which would be the other half of the double cone. A ray that starts on the
// cone has the roots 0 and -2 b / a, where -2 b comes with the ray (self_hit), computed from the
// normal there: origin - base has lost the digits that matter on a small cone far from the eye. For
// a ray from an eye on the cone, -2 b is computed here.
#ifndef RT_CONE_CL
#define RT_CONE_CL

#include "kernels/intersect.cl"

real3 cross3(real3 a, real3 b) {
    return make3(difference_of_products(a.y, b.z, a.z, b.y),
                 difference_of_products(a.z, b.x, a.x, b.z),
                 difference_of_products(a.x, b.y, a.y, b.x));
}

// How far along the rays to move before solving.
Reals cone_shift(const Ray* ray, real3 w, real3 g, real3 c, __global const Cone* cone) {
    Reals length = (Reals)cone->length;
    Reals reach = fma(fabs((Reals)cone->slope), length, (Reals)cone->base_radius) + length;
    Reals middle = -dot3(add_scaled(w, (Reals)-0.5 * length, load3(cone->axis)), ray->dir);
    Reals nearest = -(dot3(g, c) / dot3(c, c));
    return max_of(middle - reach, min_of(nearest, middle + reach));
}

// The lanes whose rays start on cone number prim.
Mask leaves_cone(const Ray* ray, __global const Cone* cone, Index prim) {
    Mask leaving = ray->from == prim;
    if (RT_HAS_EYE_ON_SURFACE && cone->touches_eye != 0) leaving |= ray->from == (Index)RT_EYE;
    return leaving;
}

// Whether the rays' lines meet the frustum in front of the origin, and at which distance t.
// `leaving`: the origin lies on this very cone.
Mask intersect_cone(const Ray* ray, __global const Cone* cone, Mask leaving, Reals* t) {
    real3 axis = load3(cone->axis);
    Reals slope = (Reals)cone->slope;
    real3 w = sub3(ray->origin, load3(cone->base));
    real3 c = cross3(ray->dir, axis);
    real3 g = cross3(w, axis);
    Reals shift = leaving ? (Reals)0 : cone_shift(ray, w, g, c, cone);
    g = add_scaled(g, shift, c);
    real3 x = cross3(g, c);
    Reals rise = dot3(ray->dir, axis);
    Reals height = fma(shift, rise, dot3(w, axis));
    Reals radius = fma(slope, height, (Reals)cone->base_radius);
    Reals m = slope * rise;
    real3 v = add_scaled(scale3(radius, c), -m, g);
    Reals discriminant = dot3(v, v) - dot3(x, x);
    Mask met = discriminant >= (Reals)0;
    met |= leaving;
    if (!any_lane(met)) return met;
    // a t^2 + 2 b t + k = 0
    Reals size = length3(c);
    Reals a = (size - m) * (size + m);
    Reals b = fma(-radius, m, dot3(g, c));
    Reals distance = length3(g);
    Reals k = (distance - radius) * (distance + radius);
    Reals root = sqrt(discriminant);
    Reals self_hit = ray->self_hit;
    if (RT_HAS_EYE_ON_SURFACE) self_hit = ray->from == (Index)RT_EYE ? (Reals)-2 * b : self_hit;
    Reals q = leaving ? self_hit : -(b + (b < (Reals)0 ? -root : root));
    Reals one = q / a;
    Mask is_single = leaving | (q == (Reals)0);
    Reals other = is_single ? one : k / q;
    Reals near = min_of(one, other);
    Reals far = max_of(one, other);
    Reals length = (Reals)cone->length;
    Reals near_height = fma(near, rise, height);
    Reals far_height = fma(far, rise, height);
    Reals near_t = shift + near;
    Reals far_t = shift + far;
    Mask near_counts = (near_t > (Reals)0) & (near_height >= (Reals)0) & (near_height <= length) &
                       (fma(near, m, radius) >= (Reals)0);
    Mask far_counts = (far_t > (Reals)0) & (far_height >= (Reals)0) & (far_height <= length) &
                      (fma(far, m, radius) >= (Reals)0);
    *t = near_counts ? near_t : far_t;
    return met & (near_counts | far_counts);
}

#endif
