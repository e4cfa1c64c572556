// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/trace/closest_hit.h"
#include "host/trace/hit_surface.h"
#include "host/trace/power.h"

// Twin of kernels/shade.cl: ambient, diffuse and specular light at a point.
namespace rt::trace {

template <typename T>
bool is_black(const Vec3<T>& color) {
    return color.x == T(0) && color.y == T(0) && color.z == T(0);
}

/// max(0, n.h)^p with h halfway between the unit directions to the light and to the eye.
template <typename T>
T specular_lobe(const Vec3<T>& normal, const Vec3<T>& to_light, const Vec3<T>& to_eye,
                T shininess) {
    const Vec3<T> sum = to_light + to_eye;
    const T along = dot3(normal, sum);
    const Vec3<T> across = add_scaled(sum, -along, normal);
    return blinn_lobe(along, dot3(across, across), dot3(sum, sum), shininess);
}

/// What one light adds at the surface; `origin` is where shadow rays start.
template <typename T>
Vec3<T> light_contribution(const SceneView<T>& scene, const Surface<T>& surface,
                           const typename Flat<T>::Material& material,
                           const typename Flat<T>::Light& light, const Vec3<T>& origin,
                           const Vec3<T>& to_eye, typename Flat<T>::Index prim, RayCounts& counts) {
    const Vec3<T> none(T(0));
    const Vec3<T> to_light = load3(light.position) - origin;
    if (!(dot3(surface.geometric, to_light) > T(0))) return none;
    const T distance = length3(to_light);
    Ray<T> shadow = leave_surface(surface, origin, to_light * (T(1) / distance), prim);
    shadow.t_max = distance * (T(1) - T(16) * Flat<T>::roundoff);
    const T cosine = dot3(surface.normal, shadow.dir);
    if (!(cosine > T(0))) return none;
    counts.shadow += 1;
    if (any_hit(scene, shadow, light)) return none;
    Vec3<T> reflected = cosine * load3(material.diffuse);
    const Vec3<T> specular = load3(material.specular);
    if (!is_black(specular)) {
        const T lobe = specular_lobe(surface.normal, shadow.dir, to_eye, material.shininess);
        reflected = add_scaled(reflected, lobe, specular);
    }
    return load3(light.intensity) * reflected;
}

template <typename T>
Vec3<T> shade(const SceneView<T>& scene, const Surface<T>& surface,
              const typename Flat<T>::Material& material, const Vec3<T>& to_eye,
              typename Flat<T>::Index prim, RayCounts& counts) {
    Vec3<T> color = load3(material.ambient) * load3(scene.frame.ambient_light);
    if (scene.frame.light_count > 0) {
        const Vec3<T> origin = offset_origin(surface, surface.geometric);
        for (typename Flat<T>::Index i = 0; i < scene.frame.light_count; ++i) {
            color += light_contribution(scene, surface, material, scene.lights[i], origin, to_eye,
                                        prim, counts);
        }
    }
    return color;
}

}  // namespace rt::trace
