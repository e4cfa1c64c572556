// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/geometric.hpp>
#include <vector>

#include "tests/exact.h"
#include "tests/probe_types.h"

// Shapes for the kernel tests, made as in host/flatten but without a view frame.
namespace rt {

template <typename T>
typename Flat<T>::Sphere make_sphere(const glm::dvec3& center, double radius, int material = 0) {
    typename Flat<T>::Sphere sphere{};
    sphere.center = pack<T>(center);
    sphere.radius = static_cast<T>(radius);
    sphere.material = material;
    return sphere;
}

template <typename T>
typename Flat<T>::Cone make_cone(const glm::dvec3& base, double base_radius, const glm::dvec3& apex,
                                 double apex_radius) {
    const double length = glm::length(apex - base);
    typename Flat<T>::Cone cone{};
    cone.base = pack<T>(base);
    cone.base_radius = static_cast<T>(base_radius);
    cone.axis = pack<T>((apex - base) / length);
    cone.length = static_cast<T>(length);
    cone.slope = static_cast<T>((apex_radius - base_radius) / length);
    cone.apex_radius = static_cast<T>(apex_radius);
    return cone;
}

inline Quad3 exact_normal(const glm::dvec3& p0, const glm::dvec3& p1, const glm::dvec3& p2) {
    return unit(cross(exact(p1) - exact(p0), exact(p2) - exact(p0)));
}

/// A flat triangle; normal, plane and offset bound come from the unrounded vertices.
template <typename T>
typename Flat<T>::Triangle make_triangle(const glm::dvec3& p0, const glm::dvec3& p1,
                                         const glm::dvec3& p2, int material = 0) {
    typename Flat<T>::Triangle triangle{};
    triangle.p0 = pack<T>(p0);
    triangle.p1 = pack<T>(p1);
    triangle.p2 = pack<T>(p2);
    triangle.material = material;
    triangle.smooth = Flat<T>::none;
    const Quad3 normal = exact_normal(p0, p1, p2);
    triangle.normal = {T(normal.x), T(normal.y), T(normal.z)};
    triangle.plane = T(dot(normal, exact(p0)));
    const glm::dvec3 low = glm::min(p0, glm::min(p1, p2)), high = glm::max(p0, glm::max(p1, p2));
    const glm::dvec3 error = 4.0 * (high - low) + 6.0 * glm::max(glm::abs(low), glm::abs(high));
    triangle.offset = static_cast<T>(double(Flat<T>::roundoff) *
                                     glm::dot(glm::abs(in_double(triangle.normal)), error));
    return triangle;
}

/// Where a ray meets a triangle: distance and barycentric weights, all positive inside.
struct ExactHit {
    Quad t, weight[3];
};
template <typename T>
ExactHit exact_hit(const ProbeRay<T>& ray, const typename Flat<T>::Triangle& triangle) {
    const Quad3 d = exact(ray.dir), o = exact(ray.origin);
    const Quad3 a = exact(triangle.p0) - o, b = exact(triangle.p1) - o, c = exact(triangle.p2) - o;
    const Quad wa = dot(d, cross(b, c)), wb = dot(d, cross(c, a)), wc = dot(d, cross(a, b));
    const Quad sum = wa + wb + wc;
    const Quad3 n = cross(b - a, c - a);
    return {dot(a, n) / dot(d, n), {wa / sum, wb / sum, wc / sum}};
}

/// Where a ray meets a sphere: both roots, and the ray's depth, 1 - (closest distance / radius)^2.
struct SphereRoots {
    Quad near, far, depth;
};
template <typename T>
SphereRoots exact_roots(const ProbeRay<T>& ray, const typename Flat<T>::Sphere& sphere) {
    const Quad3 d = exact(ray.dir), f = exact(ray.origin) - exact(sphere.center);
    const Quad squared = dot(d, d), b = -dot(f, d) / squared;
    const Quad3 l = f + b * d;
    const Quad r2 = Quad(sphere.radius) * sphere.radius, left = r2 - dot(l, l);
    const Quad s = square_root(left / squared);
    return {b - s, b + s, left / r2};
}

}  // namespace rt
