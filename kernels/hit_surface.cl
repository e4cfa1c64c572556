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
#ifndef RT_HIT_SURFACE_CL
#define RT_HIT_SURFACE_CL

#include "kernels/bits.cl"
#include "kernels/surface.cl"

// The surface of one primitive in the lanes that hit it.
Surface primitive_surface(const SceneView* scene, const Ray* ray, const Hit* hit, Index prim) {
    if (RT_HAS_SPHERES && prim < scene->params.sphere_count) {
        return sphere_surface(ray, hit->t, &scene->spheres[prim]);
    }
    Index index = prim - first_triangle(scene);
    if (RT_HAS_CONES && index < 0) {
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

// Whether a triangle was hit within rounding error of its edge, where a neighbor may begin.
Mask is_on_edge(const SceneView* scene, const Hit* hit) {
    Reals rim = (Reals)((Real)64 * (Real)RT_ROUNDOFF);
    Mask at_rim = (hit->u < rim) | (hit->v < rim) | ((Reals)1 - hit->u - hit->v < rim);
    return at_rim & (hit->prim >= first_triangle(scene));
}

// The hits' surfaces, with the points moved clear of other surfaces they touch.
Surface surface_at(const SceneView* scene, const Ray* ray, const Hit* hit, Mask live) {
    Surface surface = hit_surface(scene, ray, hit, live);
    Mask touching = live & (hit->tied | is_on_edge(scene, hit));
    if (RT_HAS_GLASS) touching |= live & (hit->t <= ray->zone);
    if (any_lane(touching)) {
        Reals tie = hit->tied ? (Reals)((Real)32 * (Real)RT_ROUNDOFF) * hit->t : (Reals)0;
        Reals back = (Reals)8 * surface.offset + tie;
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
