// SPDX-License-Identifier: Apache-2.0
//
// Whitted's recursion with mirrors alone, as a loop: the colour seen along a ray is the local light
// plus mirror x what the mirror ray sees. `throughput` is the product of the mirrors so far; the
// loop ends when it is black, when a ray misses, or after max_bounces mirror rays.
#ifndef RT_WHITTED_CL
#define RT_WHITTED_CL

#include "kernels/camera.cl"
#include "kernels/shade.cl"

// The mirror ray at a surface. Where a blended normal would send it under the surface, it is
// reflected about the geometric normal instead.
Ray mirror_ray(const Surface* surface, real3 dir, Indices prim) {
    Ray ray;
    ray.dir = reflect3(dir, surface->normal);
    if (RT_HAS_VERTEX_NORMALS) {
        Reals arriving = dot3(dir, surface->geometric);
        Mask leaves = dot3(ray.dir, surface->geometric) * arriving < (Reals)0;
        ray.dir = select3(leaves, ray.dir, reflect3(dir, surface->geometric));
    }
    ray.dir = normalize3(ray.dir);
    ray.origin = offset_origin(surface, ray.dir);
    ray.t_max = (Reals)INFINITY;
    ray.from = prim;
    return ray;
}

// The colours seen along the rays of the live lanes.
real3 trace_path(const SceneView* scene, Ray ray, Mask live, PacketCounts* counts) {
    real3 color = make3((Reals)0, (Reals)0, (Reals)0);
    real3 throughput = make3((Reals)1, (Reals)1, (Reals)1);
    for (Index bounce = 0;; ++bounce) {
        Hit hit = closest_hit(scene, &ray, live);
        Mask missed = live & (hit.prim == RT_NONE);
        if (any_lane(missed)) {
            real3 background = mul3(throughput, load3(scene->frame.background));
            color = select3(missed, add3(color, background), color);
            live &= !missed;
            if (!any_lane(live)) return color;
        }
        Surface surface = surface_at(scene, &ray, &hit, live);
        Finish finish = finish_of(scene, surface.material, live);
        Mask turned = (finish.two_sided != 0) & (dot3(surface.geometric, ray.dir) > (Reals)0);
        surface.normal = select3(turned, negate3(surface.normal), surface.normal);
        surface.geometric = select3(turned, negate3(surface.geometric), surface.geometric);
        real3 to_eye = negate3(ray.dir);
        real3 local_light = shade(scene, &surface, &finish, to_eye, hit.prim, live, counts);
        color = select3(live, add3(color, mul3(throughput, local_light)), color);
        if (!RT_HAS_MIRRORS || bounce >= scene->frame.max_bounces) return color;
        throughput = mul3(throughput, finish.mirror);
        live &= !is_black(throughput);
        if (!any_lane(live)) return color;
        ray = mirror_ray(&surface, ray.dir, hit.prim);
        counts->mirror += live & 1;
    }
}

// The colours of samples k of the pixels (x, y) in the live lanes.
real3 trace_sample(const SceneView* scene, Indices x, Indices y, Indices k, Mask live,
                   PacketCounts* counts) {
    return trace_path(scene, camera_ray(&scene->frame, x, y, k), live, counts);
}

#endif
