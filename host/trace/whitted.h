// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/trace/camera.h"
#include "host/trace/shade.h"

// Twin of kernels/whitted.cl: Whitted's recursion with mirrors alone, as a loop.
namespace rt::trace {

/// The mirror ray at a surface. Where a blended normal would send it under the surface, it is
/// reflected about the geometric normal instead.
template <typename T>
Ray<T> mirror_ray(const Surface<T>& surface, const Vec3<T>& dir, typename Flat<T>::Index prim) {
    Vec3<T> mirrored = reflect3(dir, surface.normal);
    const T arriving = dot3(dir, surface.geometric);
    if (!(dot3(mirrored, surface.geometric) * arriving < T(0))) {
        mirrored = reflect3(dir, surface.geometric);
    }
    mirrored = normalize3(mirrored);
    return leave_surface(surface, offset_origin(surface, mirrored), mirrored, prim);
}

template <typename T>
Vec3<T> trace_path(const SceneView<T>& scene, Ray<T> ray, RayCounts& counts) {
    Vec3<T> color(T(0));
    Vec3<T> throughput(T(1));
    for (typename Flat<T>::Index bounce = 0;; ++bounce) {
        const Hit<T> hit = closest_hit(scene, ray);
        if (hit.prim == Flat<T>::none) {
            return color + throughput * load3(scene.frame.background);
        }
        Surface<T> surface = surface_at(scene, ray, hit);
        const auto& material = scene.materials[surface.material];
        if (material.two_sided != 0 && dot3(surface.geometric, ray.dir) > T(0)) {
            surface.normal = -surface.normal;
            surface.geometric = -surface.geometric;
            surface.diameter = -surface.diameter;
        }
        color += throughput * shade(scene, surface, material, -ray.dir, hit.prim, counts);
        if (bounce >= scene.frame.max_bounces) return color;
        throughput = limit3(throughput * load3(material.mirror));
        if (is_black(throughput)) return color;
        ray = mirror_ray(surface, ray.dir, hit.prim);
        counts.mirror += 1;
    }
}

/// The colour of sample k of pixel (x, y).
template <typename T>
Vec3<T> trace_sample(const SceneView<T>& scene, typename Flat<T>::Index x,
                     typename Flat<T>::Index y, typename Flat<T>::Index k, RayCounts& counts) {
    counts.primary += 1;
    return trace_path(scene, camera_ray<T>(scene.frame, x, y, k), counts);
}

}  // namespace rt::trace
