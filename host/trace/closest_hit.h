// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "host/trace/bvh.h"
#include "host/trace/cone.h"
#include "host/trace/intersect.h"

// Twin of kernels/closest_hit.cl: one ray against the scene. Surfaces within 32 half-ulps of the
// nearest are one surface, and the first listed among them is hit. That set depends on the ray and
// the primitives alone, so neither hierarchies nor the order of tests change the picture.
namespace rt::trace {

template <typename T>
constexpr T tie_factor = T(1) + T(32) * Flat<T>::roundoff;

/// A ray with what the tests of primitives and boxes make of it once.
template <typename T>
struct PreparedRay {
    Ray<T> ray;
    RayShear<T> shear;
    BoxRay<T> box;  ///< only where the scene has hierarchies

    PreparedRay(const SceneView<T>& scene, const Ray<T>& r) : ray(r), shear(make_shear(r)) {
        if (scene.order) box = make_box_ray(r);
    }
};

/// Calls visit(i) for primitives 0 <= i < count of one kind, with the hierarchy `root` or none, at
/// least for those that the ray may hit no further away than `limit`, until a call returns true;
/// that is returned.
template <typename T, typename Index, typename Visit>
RT_INLINE bool visit_kind(const SceneView<T>& scene, const PreparedRay<T>& ray, Index root,
                          Index count, const T& limit, const Visit& visit) {
    if (root != 0) return visit_leaves(scene, ray.box, root, limit, visit);
    for (Index i = 0; i < count; ++i) {
        if (visit(i)) return true;
    }
    return false;
}

/// Calls visit(prim, t, u, v) for the hits with 0 < t <= limit, in no particular order.
template <typename T, typename Visit>
RT_INLINE void visit_hits(const SceneView<T>& scene, const PreparedRay<T>& ray, const T& limit,
                          const Visit& visit) {
    using Index = typename Flat<T>::Index;
    const auto& frame = scene.frame;
    visit_kind(scene, ray, frame.sphere_root, frame.sphere_count, limit, [&](Index i) {
        const T t = intersect_sphere(ray.ray, scene.spheres[i], i);
        if (t > T(0) && t <= limit) visit(i, t, T(0), T(0));
        return false;
    });
    const Index first_cone = frame.sphere_count;
    visit_kind(scene, ray, frame.cone_root, frame.cone_count, limit, [&](Index i) {
        const bool leaving = leaves_cone(ray.ray, scene.cones[i], first_cone + i);
        const T t = intersect_cone(ray.ray, scene.cones[i], leaving);
        if (t > T(0) && t <= limit) visit(first_cone + i, t, T(0), T(0));
        return false;
    });
    const Index first = first_triangle(frame);
    const Index from = ray.ray.from - first;
    const bool from_eye = ray.ray.from == Flat<T>::eye;
    visit_kind(scene, ray, frame.triangle_root, frame.triangle_count, limit, [&](Index i) {
        if (i == from) return false;
        if (from_eye && scene.triangles[i].plane == T(0)) return false;
        T u, v;
        const T t = intersect_triangle(ray.shear, scene.triangles[i], u, v);
        if (t > T(0) && t <= limit) visit(first + i, t, u, v);
        return false;
    });
}

/// The first listed of the primitives hit no further away than t_max; there is one.
template <typename T>
Hit<T> first_listed_hit(const SceneView<T>& scene, const PreparedRay<T>& ray, T t_max) {
    using Index = typename Flat<T>::Index;
    Hit<T> first{0, 0, 0, Flat<T>::none, 1};
    Index lowest = std::numeric_limits<Index>::max();
    visit_hits(scene, ray, t_max, [&](Index prim, T t, T u, T v) {
        const Index listed = scene.order ? scene.order[prim] : prim;
        if (listed >= lowest) return;
        lowest = listed;
        first = {t, u, v, prim, 1};
    });
    return first;
}

template <typename T>
Hit<T> closest_hit(const SceneView<T>& scene, const Ray<T>& r) {
    const PreparedRay<T> ray(scene, r);
    Hit<T> best{std::numeric_limits<T>::infinity(), 0, 0, Flat<T>::none, 0};
    T limit = best.t;   // best.t * tie_factor: beyond, nothing matters
    T second = best.t;  // the second smallest distance, if within the limit
    visit_hits(scene, ray, limit, [&](typename Flat<T>::Index prim, T t, T u, T v) {
        if (t < best.t) {
            second = best.t;
            best = {t, u, v, prim, 0};
            limit = t * tie_factor<T>;
        } else if (t < second) {
            second = t;
        }
    });
    if (best.prim != Flat<T>::none && second <= limit) return first_listed_hit(scene, ray, limit);
    return best;
}

template <typename T>
RT_INLINE bool any_sphere_hit(const SceneView<T>& scene, const PreparedRay<T>& ray) {
    const auto& frame = scene.frame;
    return visit_kind(scene, ray, frame.sphere_root, frame.sphere_count, ray.ray.t_max,
                      [&](typename Flat<T>::Index i) {
                          const T t = intersect_sphere(ray.ray, scene.spheres[i], i);
                          return t > T(0) && t <= ray.ray.t_max &&
                                 !ends_on_sphere(ray.ray, scene.spheres[i], t);
                      });
}

template <typename T>
RT_INLINE bool any_cone_hit(const SceneView<T>& scene, const PreparedRay<T>& ray) {
    const auto& frame = scene.frame;
    const auto from = ray.ray.from - frame.sphere_count;
    return visit_kind(scene, ray, frame.cone_root, frame.cone_count, ray.ray.t_max,
                      [&](typename Flat<T>::Index i) {
                          const T t = intersect_cone(ray.ray, scene.cones[i], i == from);
                          return t > T(0) && t <= ray.ray.t_max;
                      });
}

/// Whether the ray hits triangle i, other than the one it leaves, in (0, t_max].
template <typename T>
RT_INLINE bool hits_triangle(const SceneView<T>& scene, const PreparedRay<T>& ray,
                             typename Flat<T>::Index i) {
    if (i == ray.ray.from - first_triangle(scene.frame)) return false;
    T u, v;
    const T t = intersect_triangle(ray.shear, scene.triangles[i], u, v);
    return t > T(0) && t <= ray.ray.t_max;
}

/// Whether anything lies on the ray in (0, t_max].
template <typename T>
bool any_hit(const SceneView<T>& scene, const Ray<T>& r) {
    const PreparedRay<T> ray(scene, r);
    const auto& frame = scene.frame;
    return any_sphere_hit(scene, ray) || any_cone_hit(scene, ray) ||
           visit_kind(scene, ray, frame.triangle_root, frame.triangle_count, ray.ray.t_max,
                      [&](typename Flat<T>::Index i) { return hits_triangle(scene, ray, i); });
}

/// The same for a ray to a light, which needs to look at the light's casters only.
template <typename T>
bool any_hit(const SceneView<T>& scene, const Ray<T>& r, const typename Flat<T>::Light& light) {
    if (light.caster_count == scene.frame.triangle_count) return any_hit(scene, r);
    const PreparedRay<T> ray(scene, r);
    if (any_sphere_hit(scene, ray) || any_cone_hit(scene, ray)) return true;
    for (typename Flat<T>::Index k = 0; k < light.caster_count; ++k) {
        if (hits_triangle(scene, ray, scene.casters[light.first_caster + k])) return true;
    }
    return false;
}

}  // namespace rt::trace
