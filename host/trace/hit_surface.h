// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "host/trace/bits.h"
#include "host/trace/surface.h"

// Twin of kernels/hit_surface.cl: what a ray hits, and where further rays start from there.
namespace rt::trace {

template <typename T>
Surface<T> primitive_surface(const SceneView<T>& scene, const Ray<T>& ray, const Hit<T>& hit) {
    if (hit.prim < scene.frame.sphere_count) {
        return sphere_surface(ray, hit.t, scene.spheres[hit.prim]);
    }
    if (hit.prim < first_triangle(scene.frame)) {
        return cone_surface(ray, hit.t, scene.cones[hit.prim - scene.frame.sphere_count]);
    }
    const auto& triangle = scene.triangles[hit.prim - first_triangle(scene.frame)];
    return triangle_surface(ray, hit, triangle, scene.vertex_normals);
}

/// Whether a triangle was hit within rounding of its edge, where a neighbour may begin.
template <typename T>
bool is_on_edge(const SceneView<T>& scene, const Hit<T>& hit) {
    if (hit.prim < first_triangle(scene.frame)) return false;
    const T rim = T(64) * Flat<T>::roundoff;
    return hit.u < rim || hit.v < rim || T(1) - hit.u - hit.v < rim;
}

/// The hit's surface, its point moved clear of the other surfaces it touches.
template <typename T>
Surface<T> surface_at(const SceneView<T>& scene, const Ray<T>& ray, const Hit<T>& hit) {
    Surface<T> surface = primitive_surface(scene, ray, hit);
    if (hit.tied != 0 || is_on_edge(scene, hit)) {
        const T tie = hit.tied != 0 ? T(32) * Flat<T>::roundoff * hit.t : T(0);
        surface.point = add_scaled(surface.point, T(-8) * surface.offset - tie, ray.dir);
    }
    return surface;
}

/// Where a ray starts that leaves the surface on the side that `side` points to.
template <typename T>
Vec3<T> offset_origin(const Surface<T>& surface, const Vec3<T>& side) {
    const T distance = dot3(surface.geometric, side) < T(0) ? -surface.offset : surface.offset;
    const Vec3<T> step = distance * surface.geometric;
    const Vec3<T> p = surface.point + step;
    return {one_ulp_towards(p.x, step.x), one_ulp_towards(p.y, step.y),
            one_ulp_towards(p.z, step.z)};
}

/// A ray that leaves the surface of primitive prim in the unit direction dir, from `origin`.
template <typename T>
Ray<T> leave_surface(const Surface<T>& surface, const Vec3<T>& origin, const Vec3<T>& dir,
                     typename Flat<T>::Index prim) {
    return {origin,
            dir,
            std::numeric_limits<T>::infinity(),
            prim,
            -surface.diameter * dot3(surface.geometric, dir),
            Vec3<T>(0),
            (surface.point - origin) + surface.point_low};
}

}  // namespace rt::trace
