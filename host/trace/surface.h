// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "host/trace/cone.h"
#include "host/trace/scene_view.h"

// Twin of kernels/surface.cl: from a hit to a point and its normals.
namespace rt::trace {

template <typename T>
struct Surface {
    Vec3<T> point;
    Vec3<T> point_low;  ///< of spheres: what rounding took from the point, else 0
    Vec3<T> normal;     ///< shading normal, unit: interpolated where there are vertex normals
    Vec3<T> geometric;  ///< geometric normal, unit, on the shading normal's side
    T offset;           ///< bound on the distance between point and surface
    /// Of a sphere, and what stands for it on a cone: the length of the gradient of the terms that
    /// vanish on it. Negative where the geometric normal points inwards; 0 on triangles.
    T diameter;
    typename Flat<T>::Index material;
};

/// The normal where the ray meets the sphere at t, from the closest approach and the half chord.
template <typename T>
Vec3<T> sphere_normal(const Ray<T>& ray, T t, const typename Flat<T>::Sphere& sphere) {
    const Vec3<T> f = ray.origin - load3(sphere.center);
    const T b = -dot3(f, ray.dir);
    Vec3<T> l = add_scaled(f, b, ray.dir);
    l = add_scaled(ray.origin_low + l, t, ray.dir_low) - load3(sphere.center_low);
    l = add_scaled(l, -dot3(l, ray.dir), ray.dir);
    const T squared = sphere.radius * sphere.radius - dot3(l, l);
    const T s = squared > T(0) ? std::sqrt(squared) : T(0);
    return normalize3(add_scaled(l, t < b ? -s : s, ray.dir));
}

template <typename T>
Surface<T> sphere_surface(const Ray<T>& ray, T t, const typename Flat<T>::Sphere& sphere) {
    const Vec3<T> center = load3(sphere.center);
    Surface<T> surface{};
    surface.normal = sphere_normal(ray, t, sphere);
    surface.geometric = surface.normal;
    const Vec3<T> out = add_scaled(load3(sphere.center_low), sphere.radius, surface.normal);
    surface.point = center + out;
    surface.point_low = (center - surface.point) + out;
    const T spread = dot3(abs3(surface.normal), abs3(center) + abs3(surface.point));
    surface.offset = Flat<T>::roundoff * std::fma(T(5), sphere.radius, spread);
    if (sphere.is_huge != 0) {
        surface.point = add_scaled(ray.origin, t, ray.dir);
        surface.point_low = Vec3<T>(0);
        surface.normal = normalize3(surface.point - center);
        surface.geometric = surface.normal;
        const Vec3<T> error = add_scaled(T(4) * abs3(ray.origin), T(6), abs3(surface.point));
        surface.offset = Flat<T>::roundoff * dot3(abs3(surface.normal), error);
    }
    surface.diameter = T(2) * sphere.radius;
    surface.material = sphere.material;
    return surface;
}

/// The point is put back on the cone at its height; on the axis, where the radius is 0, the normal
/// faces the viewer.
template <typename T>
Surface<T> cone_surface(const Ray<T>& ray, T t, const typename Flat<T>::Cone& cone) {
    const Vec3<T> base = load3(cone.base);
    const Vec3<T> axis = load3(cone.axis);
    const Vec3<T> along = add_scaled(ray.origin - base, t, ray.dir);
    const T height = min_of(max_of(dot3(along, axis), T(0)), cone.length);
    const T radius = max_of(std::fma(cone.slope, height, cone.base_radius), T(0));
    const Vec3<T> center = add_scaled(base, height, axis);
    Vec3<T> outwards = add_scaled(along, -height, axis);
    const T squared = dot3(outwards, outwards);
    Surface<T> surface{};
    surface.normal = -ray.dir;
    surface.point = center;
    if (squared > T(0)) {
        outwards = outwards * (T(1) / std::sqrt(squared));
        surface.normal = normalize3(add_scaled(outwards, -cone.slope, axis));
        surface.point = add_scaled(center, radius, outwards);
    }
    surface.geometric = surface.normal;
    const Vec3<T> size = abs3(center) + abs3(surface.point);
    const T extent = T(8) * std::fma(std::fabs(cone.slope), cone.length, cone.base_radius);
    surface.offset = Flat<T>::roundoff * (dot3(abs3(surface.normal), size) + extent);
    surface.diameter = T(2) * radius * std::sqrt(std::fma(cone.slope, cone.slope, T(1)));
    surface.material = cone.material;
    return surface;
}

/// The normal blended from the vertices, or the face's own where the blend vanishes.
template <typename T>
Vec3<T> blended_normal(const typename Flat<T>::VertexNormals& normals, const Vec3<T>& face, T u,
                       T v) {
    Vec3<T> blend = (T(1) - u - v) * load3(normals.n0);
    blend = add_scaled(blend, u, load3(normals.n1));
    blend = add_scaled(blend, v, load3(normals.n2));
    const T squared = dot3(blend, blend);
    return squared > T(1e-12) ? blend * (T(1) / std::sqrt(squared)) : face;
}

template <typename T>
T largest_coordinate(const typename Flat<T>::Triangle& triangle) {
    T largest = 0;
    for (const auto& p : {triangle.p0, triangle.p1, triangle.p2}) {
        for (const T x : {p.x, p.y, p.z}) largest = std::max(largest, std::fabs(x));
    }
    return largest;
}

template <typename T>
Surface<T> triangle_surface(const Ray<T>& ray, const Hit<T>& hit,
                            const typename Flat<T>::Triangle& triangle,
                            const typename Flat<T>::VertexNormals* vertex_normals) {
    const Vec3<T> normal = load3(triangle.normal);
    const Vec3<T> p0 = load3(triangle.p0);
    Surface<T> surface{};
    surface.point = add_scaled(p0, hit.u, load3(triangle.p1) - p0);
    surface.point = add_scaled(surface.point, hit.v, load3(triangle.p2) - p0);
    surface.offset = triangle.offset;
    const T distance = length3(ray.origin) + hit.t;
    if (largest_coordinate<T>(triangle) > T(8) * distance) {
        const Vec3<T> along = add_scaled(ray.origin, hit.t, ray.dir);
        surface.point = add_scaled(along, triangle.plane - dot3(normal, along), normal);
        surface.offset = T(16) * Flat<T>::roundoff * distance;
    }
    surface.normal = normal;
    surface.geometric = normal;
    surface.diameter = 0;
    surface.material = triangle.material;
    if (triangle.smooth != Flat<T>::none) {
        surface.normal = blended_normal(vertex_normals[triangle.smooth], normal, hit.u, hit.v);
        if (dot3(surface.normal, normal) < T(0)) surface.geometric = -normal;
    }
    return surface;
}

}  // namespace rt::trace
