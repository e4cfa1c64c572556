// SPDX-License-Identifier: Apache-2.0
//
// Rays against the side of a cone's frustum, open at both ends; a cylinder has slope 0.
//
// With w from the base to the ray's origin, g = w x axis and c = dir x axis are the components
// across the axis, turned by 90 degrees, and a point at t lies on the (double) cone where |g + t c|
// = |R + m t|, R being the radius at the origin's height and m = slope (dir.axis). The cross
// products use differences of products, hence keep their digits when the ray runs along the axis.
//
// The origin is first moved to the ray's closest approach to the axis (on a flat cone, to half the
// height), or as near to it as the frustum reaches, so that nothing much larger than the frustum is
// ever subtracted. The
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

// A cone this flat has no height to speak of: roots count if their radius is between the rims', and
// the rays are moved to half the height, wherever rounding puts that. Rays that are still above or
// below both rims where they come nearest to it miss the cone.
bool is_flat(__global const Cone* cone) { return fabs((Real)cone->slope) > (Real)16; }

// The most that rays are moved from the closest approach to the middle of the cone.
Reals cone_reach(__global const Cone* cone) {
    return fma(fabs((Reals)cone->slope), (Reals)cone->length, (Reals)cone->base_radius) +
           (Reals)cone->length;
}

// `goal` is where along the rays to solve; as near to it as the cone reaches.
Reals cone_shift(const Ray* ray, real3 w, Reals goal, __global const Cone* cone) {
    Reals reach = cone_reach(cone);
    real3 axis = load3(cone->axis);
    Reals middle = -dot3(add_scaled(w, (Reals)-0.5f * (Reals)cone->length, axis), ray->dir);
    return max_of(middle - reach, min_of(goal, middle + reach));
}

// The lanes whose rays start on cone number prim.
Mask leaves_cone(const Ray* ray, __global const Cone* cone, Index prim) {
    Mask leaving = ray->from == prim;
    if (eye_side(cone->touches) != 0) leaving |= ray->from == (Index)RT_EYE;
    return leaving;
}

// Where the rays' lines meet a cone, and whether that counts: on the frustum and in front.
typedef struct {
    Reals near, far;
    Mask near_counts, far_counts;
    Mask is_far_outwards;  // the farther one leads outwards, the nearer one inwards
} ConeRoots;

// `leaving`: the origin lies on this very cone. `ends_inside`: the rays do, so that they meet it
// even where rounding has them pass by. No root counts in lanes that are not met.
ConeRoots cone_roots(const Ray* ray, __global const Cone* cone, Mask leaving, bool ends_inside) {
    ConeRoots roots;
    roots.near = roots.far = (Reals)0;
    roots.near_counts = roots.far_counts = roots.is_far_outwards = RT_NO_LANES;
    real3 axis = load3(cone->axis);
    Reals slope = (Reals)cone->slope;
    real3 w = sub3(ray->origin, load3(cone->base));
    real3 c = cross3(ray->dir, axis);
    real3 g = cross3(w, axis);
    bool flat = is_flat(cone);
    Reals rise = dot3(ray->dir, axis);
    Reals start = dot3(w, axis);
    Reals middle = (Reals)0.5f * (Reals)cone->length;
    Reals goal = flat ? (middle - start) / rise : -(dot3(g, c) / dot3(c, c));
    Reals shift = leaving ? (Reals)0 : cone_shift(ray, w, goal, cone);
    g = add_scaled(g, shift, c);
    Reals height = fma(shift, rise, start);
    Reals radius = fma(slope, height, (Reals)cone->base_radius);
    Reals m = slope * rise;
    Reals unit = (Reals)1;  // of distances from here on: a flat cone's m may be huge
    Mask misses = RT_NO_LANES;
    if (flat) {
        Real mean = (Real)0.5f * (cone->base_radius + cone->apex_radius);
        Real width = fabs(cone->base_radius - cone->apex_radius);
        Mask is_there = shift == goal;
        misses = !(leaving | is_there | (fabs(radius - (Reals)mean) <= (Reals)width));
        radius = leaving ? length3(g) : (is_there ? (Reals)mean : radius);
        unit = (Reals)1 / max_of(fabs(m), length3(c));
        m = unit * m;
        c = scale3(unit, c);
    }
    real3 x = cross3(g, c);
    real3 v = add_scaled(scale3(radius, c), -m, g);
    Reals discriminant = dot3(v, v) - dot3(x, x);
    if (ends_inside) discriminant = max_of(discriminant, (Reals)0);
    Mask met = discriminant >= (Reals)0;
    met |= leaving;
    met &= !misses;
    if (!any_lane(met)) return roots;
    // a t^2 + 2 b t + k = 0
    Reals size = length3(c);
    Reals a = (size - m) * (size + m);
    Reals b = fma(-radius, m, dot3(g, c));
    Reals distance = length3(g);
    Reals k = (distance - radius) * (distance + radius);
    Reals root = sqrt(discriminant);
    Reals self_hit = ray->self_hit * unit;
    Mask from_eye = RT_NO_LANES;
    if (RT_HAS(EYE_ON_SURFACE)) {
        from_eye = leaving & (ray->from == (Index)RT_EYE);
        self_hit = from_eye ? (Reals)-2 * b : self_hit;
    }
    Reals q = leaving ? self_hit : -(b + (b < (Reals)0 ? -root : root));
    Reals one = q / a;
    Mask is_single = leaving | (q == (Reals)0);
    Reals other = is_single ? one : k / q;
    if (RT_HAS(EYE_ON_SURFACE) && any_lane(from_eye)) {
        Mask at_once = from_eye & starts_through(eye_side(cone->touches), b > (Reals)0);
        other = at_once ? (Real)RT_ROUNDOFF * radius : other;
    }
    Reals near = min_of(one, other);
    Reals far = max_of(one, other);
    Reals near_radius = fma(near, m, radius);
    Reals far_radius = fma(far, m, radius);
    roots.is_far_outwards = a > (Reals)0;
    roots.near = fma(unit, near, shift);
    roots.far = fma(unit, far, shift);
    roots.near_counts = met & (roots.near > (Reals)0) & (near_radius >= (Reals)0);
    roots.far_counts = met & (roots.far > (Reals)0) & (far_radius >= (Reals)0);
    if (flat) {
        Real rim = cone->base_radius, other_rim = cone->apex_radius;
        Reals least = (Reals)(rim < other_rim ? rim : other_rim);
        Reals most = (Reals)(rim < other_rim ? other_rim : rim);
        roots.near_counts &= (near_radius >= least) & (near_radius <= most);
        roots.far_counts &= (far_radius >= least) & (far_radius <= most);
    } else {
        Reals length = (Reals)cone->length;
        Reals near_height = fma(near, rise, height);
        Reals far_height = fma(far, rise, height);
        roots.near_counts &= (near_height >= (Reals)0) & (near_height <= length);
        roots.far_counts &= (far_height >= (Reals)0) & (far_height <= length);
    }
    return roots;
}

// Whether the rays' lines meet the frustum in front of the origin, and at which distance t; if that
// is the nearer of two, *far is the other.
Mask intersect_cone(const Ray* ray, __global const Cone* cone, Mask leaving, Reals* t, Reals* far) {
    ConeRoots roots = cone_roots(ray, cone, leaving, false);
    *far = roots.far_counts ? roots.far : (Reals)0;
    *t = roots.near_counts ? roots.near : roots.far;
    return roots.near_counts | roots.far_counts;
}

// Whether shadow rays meet the frustum in (0, t_max], before the light with this place in its bits.
// Towards a light on the tip both roots are the light.
Mask meets_cone_before(const Ray* ray, __global const Cone* cone, Mask leaving, Reals t_max,
                       Index light) {
    Index side = light_side(cone->touches, light);
    ConeRoots roots = cone_roots(ray, cone, leaving, side == RT_INSIDE);
    if (side == 0) {
        return (roots.near_counts & (roots.near <= t_max)) |
               (roots.far_counts & (roots.far <= t_max));
    }
    Real size = cone->base_radius + cone->apex_radius + cone->length;
    real3 way = add_scaled(sub3(ray->origin, load3(cone->base)), t_max, ray->dir);
    Mask is_tip = length3(cross3(way, load3(cone->axis))) <=
                  (Reals)((Real)64 * (Real)RT_ROUNDOFF) * (t_max + size);
    Mask near_is_nearer = fabs(roots.near - t_max) <= fabs(roots.far - t_max);
    Mask near = is_before_light(roots.near, !roots.is_far_outwards, is_tip | near_is_nearer, side,
                                t_max, size);
    Mask far = is_before_light(roots.far, roots.is_far_outwards, is_tip | leaving | !near_is_nearer,
                               side, t_max, size);
    return (roots.near_counts & near & !leaving) | (roots.far_counts & far);  // leaving: one root
}

#endif
