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
Ray mirror_ray(const Surface* surface, real3 dir, Index prim) {
    Ray ray;
    ray.dir = reflect3(dir, surface->normal);
    if (RT_HAS_VERTEX_NORMALS) {
        Real arriving = dot3(dir, surface->geometric);
        if (!(dot3(ray.dir, surface->geometric) * arriving < (Real)0)) {
            ray.dir = reflect3(dir, surface->geometric);
        }
    }
    ray.dir = normalize3(ray.dir);
    ray.origin = offset_origin(surface, ray.dir);
    ray.t_max = INFINITY;
    ray.from = prim;
    return ray;
}

real3 trace_path(const SceneView* scene, Ray ray, RayCounts* counts) {
    real3 color = {0, 0, 0};
    real3 throughput = {1, 1, 1};
    for (Index bounce = 0;; ++bounce) {
        Hit hit = closest_hit(scene, &ray);
        if (hit.prim == RT_NONE)
            return add3(color, mul3(throughput, load3(scene->frame.background)));
        Surface surface = surface_at(scene, &ray, &hit);
        __global const Material* material = &scene->materials[surface.material];
        if (material->two_sided != 0 && dot3(surface.geometric, ray.dir) > (Real)0) {
            surface.normal = negate3(surface.normal);
            surface.geometric = negate3(surface.geometric);
        }
        real3 local_light = shade(scene, &surface, material, negate3(ray.dir), hit.prim, counts);
        color = add3(color, mul3(throughput, local_light));
        if (!RT_HAS_MIRRORS || bounce >= scene->frame.max_bounces) return color;
        throughput = mul3(throughput, load3(material->mirror));
        if (is_black(throughput)) return color;
        ray = mirror_ray(&surface, ray.dir, hit.prim);
        counts->mirror += 1;
    }
}

// The colour of sample k of pixel (x, y).
real3 trace_sample(const SceneView* scene, Index x, Index y, Index k, RayCounts* counts) {
    return trace_path(scene, camera_ray(&scene->frame, x, y, k), counts);
}

#endif
