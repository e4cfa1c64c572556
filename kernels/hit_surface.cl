// SPDX-License-Identifier: Apache-2.0
//
// The surfaces a packet's rays hit, and the origins of secondary rays there.
//
// A secondary ray starts off the surface by the bound on the point's error, along the geometric
// normal, and one ulp further (after Pharr, Jakob and Humphreys, PBR 4th ed., 6.8). Where the ray
// met several surfaces at once, or a triangle within rounding error of its edge, that offset clears
// only one of them, and rounding would decide whether the neighbor is in the way. There the point
// moves back along the ray, by eight offsets plus the tie distance, to the viewer's side of all of
// them; shadow rays to lights on the other side start as far beyond them. A refracted ray crosses
// them in the scene's order, each once, and of neighbors that share an edge only one (Ray::zone).
//
// None of this tells on which side of a neighbor's plane a point next to an edge is that the ray
// reached almost parallel to that plane. So near edges points also move into their triangle
// (clear_of_edges).
#ifndef RT_HIT_SURFACE_CL
#define RT_HIT_SURFACE_CL

#include "kernels/bits.cl"
#include "kernels/surface.cl"

// The surface of one primitive in the lanes that hit it.
Surface primitive_surface(const SceneView* scene, const Ray* ray, const Hit* hit, Index prim) {
    if (RT_HAS(SPHERES) && prim < scene->params.sphere_count) {
        return sphere_surface(ray, hit->t, &scene->spheres[prim]);
    }
    Index index = prim - first_triangle(scene);
    if (RT_HAS(CONES) && index < 0) {
        return cone_surface(ray, hit->t, &scene->cones[prim - scene->params.sphere_count]);
    }
    return triangle_surface(ray, hit, &scene->triangles[index], scene->vertex_normals);
}

Surface select_surface(Mask mask, Surface yes, Surface no) {
    Surface chosen;
    chosen.point = select3(mask, yes.point, no.point);
    chosen.point_low = select3(mask, yes.point_low, no.point_low);
    chosen.normal = select3(mask, yes.normal, no.normal);
    chosen.geometric = select3(mask, yes.geometric, no.geometric);
    chosen.offset = mask ? yes.offset : no.offset;
    chosen.signed_diameter = mask ? yes.signed_diameter : no.signed_diameter;
    chosen.back = (Reals)0;
    chosen.material = mask ? yes.material : no.material;
    return chosen;
}

// Every live lane's surface: one primitive after the other, for all the lanes that hit it.
Surface hit_surface(const SceneView* scene, const Ray* ray, const Hit* hit, Mask live) {
    Surface surface;
    surface.back = (Reals)0;
    surface.material = (Indices)0;
    for (Mask left = live; any_lane(left);) {
        Index prim = least_lane(left, hit->prim);
        Mask lanes = left & (hit->prim == prim);
        left &= !lanes;
        surface = select_surface(lanes, primitive_surface(scene, ray, hit, prim), surface);
    }
    return surface;
}

// The least weight of a vertex where a triangle was hit: 0 on an edge. Elsewhere infinity.
Reals edge_weight(const SceneView* scene, const Hit* hit) {
    Reals least = min_of(min_of(hit->u, hit->v), (Reals)1 - hit->u - hit->v);
    return hit->prim >= first_triangle(scene) ? least : (Reals)INFINITY;
}

// Whether a triangle was hit within rounding error of its edge, where a neighbor may begin.
Mask is_on_edge(const SceneView* scene, const Hit* hit) {
    return edge_weight(scene, hit) < (Reals)((Real)64 * (Real)RT_ROUNDOFF);
}

// The least sine of an angle between two faces that points next to their edge must clear.
#define RT_SHARPEST 0x1p-7f

// How far, as a share of the way to the incenter, a point must move from an edge to be clear of it.
Reals edge_share(real3 side, Reals length, Reals weight, real3 dir, Reals sine, Reals error) {
    Reals across = length3(add_scaled(dir, -dot3(dir, side) / (length * length), side));
    Reals away = error / max_of(sine / across, (Reals)RT_SHARPEST);
    return min_of(away, (Reals)0x1p-6f) - (Reals)2 * weight;
}

// Near a triangle's edge, the point as far inside the triangle that rounding cannot put it beyond
// the neighbor's plane: the error over the sine of the ray's angle to the face, seen along the
// edge, since rays from between two faces meet each at less than their angle. Towards the incenter,
// which clears all three edges.
real3 clear_of_edges(const Ray* ray, const Hit* hit, real3 point,
                     __global const Triangle* triangle) {
    real3 p0 = load3(triangle->p0), p1 = load3(triangle->p1), p2 = load3(triangle->p2);
    real3 side0 = sub3(p2, p1), side1 = sub3(p0, p2), side2 = sub3(p1, p0);
    Reals length0 = length3(side0), length1 = length3(side1), length2 = length3(side2);
    Reals scale = (Reals)1 / (length0 + length1 + length2);
    real3 incenter = scale3(scale * length0, p0);
    incenter = add_scaled(incenter, scale * length1, p1);
    incenter = add_scaled(incenter, scale * length2, p2);
    Reals inradius = length3(cross3(scale3(scale, side0), side1));
    Reals size = min_of((Reals)largest_coordinate(triangle), length3(ray->origin) + hit->t);
    Reals error = (Reals)((Real)32 * (Real)RT_ROUNDOFF) * size / inradius;
    Reals sine = fabs(dot3(load3(triangle->normal), ray->dir));
    Reals weight0 = (Reals)1 - hit->u - hit->v;
    Reals share = edge_share(side0, length0, weight0, ray->dir, sine, error);
    share = max_of(share, edge_share(side1, length1, hit->u, ray->dir, sine, error));
    share = max_of(share, edge_share(side2, length2, hit->v, ray->dir, sine, error));
    return add_scaled(point, max_of(share, (Reals)0), sub3(incenter, point));
}

// The hits' surfaces, with the points moved clear of other surfaces they touch. At least one lane
// must be live.
Surface surface_at(const SceneView* scene, const Ray* ray, const Hit* hit, Mask live) {
    Surface surface = hit_surface(scene, ray, hit, live);
    Reals sine = max_of(fabs(dot3(surface.geometric, ray->dir)), (Reals)RT_SHARPEST);
    Reals nearness = edge_weight(scene, hit) * sine;
    Mask near = live & (nearness < (Reals)((Real)4096 * (Real)RT_ROUNDOFF));
    for (Mask left = near; any_lane(left);) {
        Index prim = least_lane(left, hit->prim);
        Mask lanes = left & (hit->prim == prim);
        left &= !lanes;
        real3 clear = clear_of_edges(ray, hit, surface.point,
                                     &scene->triangles[prim - first_triangle(scene)]);
        surface.point = select3(lanes, clear, surface.point);
    }
    Mask touching = live & (hit->tied | is_on_edge(scene, hit));
    if (RT_HAS(GLASS)) touching |= live & (hit->t <= ray->zone);
    if (any_lane(touching)) {
        Reals tie = max_of(RT_TIE * (hit->t + length3(ray->origin)), hit->behind);
        Reals back = (Reals)8 * surface.offset + (hit->tied ? tie : (Reals)0);
        back = min_of(back, (Reals)0.5f * hit->t);  // not beyond what the ray started from
        real3 moved = add_scaled(surface.point, -back, ray->dir);
        surface.point = select3(touching, moved, surface.point);
        surface.back = touching ? back : (Reals)0;
    }
    return surface;
}

// The origin of a ray that leaves the surface on the side that `side` points to.
real3 offset_origin(const Surface* surface, real3 side) {
    Mask behind = dot3(surface->geometric, side) < (Reals)0;
    real3 step = scale3(behind ? -surface->offset : surface->offset, surface->geometric);
    real3 p = add3(surface->point, step);
    return make3(one_ulp_towards(p.x, step.x), one_ulp_towards(p.y, step.y),
                 one_ulp_towards(p.z, step.z));
}

// A ray that leaves the surface of primitive prim in the unit direction dir, from `origin`.
Ray spawn_ray(const Surface* surface, real3 origin, real3 dir, Indices prim) {
    Ray ray;
    ray.origin = origin;
    ray.dir = dir;
    ray.dir_low = make3((Reals)0, (Reals)0, (Reals)0);
    ray.origin_low = add3(sub3(surface->point, origin), surface->point_low);
    ray.t_max = (Reals)INFINITY;
    ray.self_hit = -surface->signed_diameter * dot3(surface->geometric, dir);
    ray.from = prim;
    ray.zone = (Reals)0;
    ray.left = ray.left_side = (Indices)0;
    return ray;
}

#endif
