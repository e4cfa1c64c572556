// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "host/trace/camera.h"
#include "host/trace/shade.h"

// Twin of kernels/whitted.cl: Whitted's recursion as a loop, the ray tree walked with a stack.
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

/// The refracted ray at a surface, where `eta` is the index of refraction on the side the ray comes
/// from over that on the other side. `total` where all light is reflected instead. Where a blended
/// normal would leave the ray on the side it came from, it is refracted about the geometric normal.
template <typename T>
Ray<T> refracted_ray(const Surface<T>& surface, const Vec3<T>& dir, T eta,
                     typename Flat<T>::Index prim, bool& total) {
    Vec3<T> refracted;
    const T arriving = dot3(dir, surface.geometric);
    for (const Vec3<T>& normal : {surface.normal, surface.geometric}) {
        const T cosine = dot3(dir, normal);
        const Vec3<T> along = add_scaled(dir, -cosine, normal);
        const T squared = T(1) - eta * eta * dot3(along, along);
        const T depth = std::sqrt(squared);
        const Vec3<T> bent = add_scaled(eta * along, cosine < T(0) ? -depth : depth, normal);
        total = !(squared >= T(0));
        refracted = eta == T(1) ? dir : normalize3(bent);
        if (total || dot3(refracted, surface.geometric) * arriving > T(0)) break;
    }
    return leave_surface(surface, offset_origin(surface, refracted), refracted, prim);
}

/// A ray and how much of what it sees counts.
template <typename T>
struct Path {
    Ray<T> ray;
    Vec3<T> throughput;
    typename Flat<T>::Index bounce;
};

/// Refracted rays put aside while the mirror rays of the same hits are followed.
template <typename T>
struct Pending {
    std::array<Path<T>, f32::RT_TREE_STACK> paths;
    std::size_t size = 0;
};

/// Too dark to change a picture: below half an ulp of white.
template <typename T>
bool is_faint(const Vec3<T>& weight) {
    return !(max_of(weight.x, max_of(weight.y, weight.z)) >= Flat<T>::roundoff);
}

/// Sends the path on from a surface; `inside` where the ray came from behind it. False where it
/// ends.
template <typename T>
bool scatter(const Surface<T>& surface, const typename Flat<T>::Material& material,
             typename Flat<T>::Index prim, bool inside, Path<T>& path, Pending<T>& pending,
             RayCounts& counts) {
    Vec3<T> reflected = limit3(path.throughput * load3(material.mirror));
    const Vec3<T> dir = path.ray.dir;
    path.bounce += 1;
    if (is_black(load3(material.transmission))) {
        path.throughput = reflected;
        if (is_black(reflected)) return false;
        path.ray = mirror_ray(surface, dir, prim);
        counts.mirror += 1;
        return true;
    }
    const Vec3<T> transmitted = limit3(path.throughput * load3(material.transmission));
    bool total;
    const T eta = inside ? material.ior : T(1) / material.ior;
    const Ray<T> refracted = refracted_ray(surface, dir, eta, prim, total);
    if (total) reflected = limit3(reflected + transmitted);
    const bool transmits = !total && !is_faint(transmitted);
    const bool reflects = !is_faint(reflected);
    if (reflects && transmits) {
        pending.paths[pending.size++] = {refracted, transmitted, path.bounce};
    }
    path.ray = reflects ? mirror_ray(surface, dir, prim) : refracted;
    path.throughput = reflects ? reflected : transmitted;
    counts.mirror += reflects ? 1 : 0;
    counts.transmitted += transmits ? 1 : 0;
    return reflects || transmits;
}

/// What a hit adds to the colour, and the path from there on. False where it ends.
template <typename T>
bool meet_surface(const SceneView<T>& scene, const Hit<T>& hit, Vec3<T>& color, Path<T>& path,
                  Pending<T>& pending, RayCounts& counts) {
    Surface<T> surface = surface_at(scene, path.ray, hit);
    const auto& material = scene.materials[surface.material];
    const bool inside = dot3(surface.geometric, path.ray.dir) > T(0);
    if (material.two_sided != 0 && inside) {
        surface.normal = -surface.normal;
        surface.geometric = -surface.geometric;
        surface.diameter = -surface.diameter;
    }
    color += path.throughput * shade(scene, surface, material, -path.ray.dir, hit.prim, counts);
    if (path.bounce >= scene.frame.max_bounces) return false;
    return scatter(surface, material, hit.prim, inside, path, pending, counts);
}

template <typename T>
Vec3<T> trace_path(const SceneView<T>& scene, const Ray<T>& ray, RayCounts& counts) {
    Vec3<T> color(T(0));
    Path<T> path{ray, Vec3<T>(T(1)), 0};
    Pending<T> pending;
    for (;;) {
        const Hit<T> hit = closest_hit(scene, path.ray);
        if (hit.prim == Flat<T>::none) {
            color += path.throughput * load3(scene.frame.background);
        } else if (meet_surface(scene, hit, color, path, pending, counts)) {
            continue;
        }
        if (pending.size == 0) return color;
        path = pending.paths[--pending.size];
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
