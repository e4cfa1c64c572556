// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "host/flatten/flat_scene.h"
#include "tests/test_random.h"
#include "tests/test_shapes.h"

// Scenes for the kernel tests, and rays for them.
namespace rt {

/// Sets the frame's counts; all triangles cast shadows.
template <typename T>
void count_primitives(FlatScene<T>& scene) {
    if (scene.materials.empty()) scene.materials.resize(max_bvh_depth + 1);  // not glass
    scene.params.sphere_count = static_cast<Index<T>>(scene.spheres.size());
    scene.params.cone_count = static_cast<Index<T>>(scene.cones.size());
    scene.params.triangle_count = static_cast<Index<T>>(scene.triangles.size());
    scene.params.light_count = static_cast<Index<T>>(scene.lights.size());
    for (auto& light : scene.lights) light.caster_count = scene.params.triangle_count;
}

/// Spheres and triangles around the origin, some of them duplicated.
template <typename T>
FlatScene<T> crowd(Random& random) {
    FlatScene<T> scene{};
    for (int i = 0; i < 12; ++i) {
        scene.spheres.push_back(make_sphere<T>(3.0 * random.unit_vector(), random.uniform(0.2, 1)));
    }
    scene.spheres.push_back(scene.spheres[3]);
    for (int i = 0; i < 12; ++i) {
        const glm::dvec3 p = 2.0 * random.unit_vector();
        const auto corner = [&] { return p + random.in_cube(1); };
        scene.triangles.push_back(make_triangle<T>(corner(), corner(), corner()));
    }
    scene.triangles.push_back(scene.triangles[5]);
    count_primitives(scene);
    return scene;
}

template <typename T>
std::vector<ProbeRay<T>> rays_about(Random& random, std::size_t count) {
    return many(count, [&] {
        auto ray = make_ray<T>(random.in_cube(1.5), random.unit_vector());
        ray.t_max = static_cast<T>(random.uniform(0.1, 6));
        ray.from = static_cast<Index<T>>(random.index(30) - 4);
        ray.self_hit = static_cast<T>(random.uniform(-2, 4));
        return ray;
    });
}

}  // namespace rt
