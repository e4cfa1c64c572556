// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "host/trace/intersect.h"

// Twin of kernels/closest_hit.cl: one ray against the scene; ties go to the lowest index.
namespace rt::trace {

template <typename T>
constexpr T tie_factor = T(1) + T(32) * Flat<T>::roundoff;

/// Distance to primitive `prim`, or -1 (or NaN) where it is missed.
template <typename T>
T intersect_primitive(const SceneView<T>& scene, const Ray<T>& ray, const RayShear<T>& shear,
                      typename Flat<T>::Index prim, T& u, T& v) {
    if (prim < scene.frame.sphere_count) {
        const auto& sphere = scene.spheres[prim];
        return intersect_sphere(ray, load3(sphere.center), sphere.radius, prim == ray.from);
    }
    if (prim == ray.from) return T(-1);
    return intersect_triangle(shear, scene.triangles[prim - scene.frame.sphere_count], u, v);
}

/// The lowest-numbered primitive hit no further away than t_max; there is one.
template <typename T>
Hit<T> first_listed_hit(const SceneView<T>& scene, const Ray<T>& ray, const RayShear<T>& shear,
                        T t_max) {
    const auto count = scene.frame.sphere_count + scene.frame.triangle_count;
    Hit<T> hit{0, 0, 0, Flat<T>::none, 1};
    for (typename Flat<T>::Index prim = 0; prim < count; ++prim) {
        hit.t = intersect_primitive(scene, ray, shear, prim, hit.u, hit.v);
        if (hit.t > T(0) && hit.t <= t_max) {
            hit.prim = prim;
            return hit;
        }
    }
    return hit;
}

template <typename T>
Hit<T> closest_hit(const SceneView<T>& scene, const Ray<T>& ray) {
    const auto count = scene.frame.sphere_count + scene.frame.triangle_count;
    const RayShear<T> shear = make_shear(ray);
    Hit<T> best{std::numeric_limits<T>::infinity(), 0, 0, Flat<T>::none, 0};
    T second = std::numeric_limits<T>::infinity();
    for (typename Flat<T>::Index prim = 0; prim < count; ++prim) {
        T u = 0, v = 0;
        const T t = intersect_primitive(scene, ray, shear, prim, u, v);
        if (t > T(0) && t < second) {
            if (t < best.t) {
                second = best.t;
                best = {t, u, v, prim, 0};
            } else {
                second = t;
            }
        }
    }
    const T tie = best.t * tie_factor<T>;
    if (best.prim != Flat<T>::none && second <= tie) {
        return first_listed_hit(scene, ray, shear, tie);
    }
    return best;
}

/// Whether anything lies on the ray in (0, t_max].
template <typename T>
bool any_hit(const SceneView<T>& scene, const Ray<T>& ray) {
    const auto count = scene.frame.sphere_count + scene.frame.triangle_count;
    const RayShear<T> shear = make_shear(ray);
    for (typename Flat<T>::Index prim = 0; prim < count; ++prim) {
        T u, v;
        const T t = intersect_primitive(scene, ray, shear, prim, u, v);
        if (t > T(0) && t <= ray.t_max) return true;
    }
    return false;
}

}  // namespace rt::trace
