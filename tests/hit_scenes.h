// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "host/flatten/flat_scene.h"
#include "tests/test_random.h"
#include "tests/test_shapes.h"

// Scenes in which a hierarchy could miss hits, and rays that look for such misses.
namespace rt {

struct HitScene {
    const char* name;
    std::function<void(Scene&, Random&)> fill;
    bool is_textbook = true;  ///< false: textbook formulas are useless in long double, too
};

const std::vector<HitScene>& hit_scenes();

/// The scene, with a material and a camera.
Scene make_scene(const HitScene& made_of);

void add_triangle(Scene& scene, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

/// n x n squares in the plane at height z, centered on the z axis, two triangles each.
void add_floor(Scene& scene, int n, double half, double z = 0);

/// A flat scene, and its primitives' numbers in the original scene, both ways.
template <typename T>
struct Numbered {
    using Index = typename Flat<T>::Index;

    FlatScene<T> scene;
    std::vector<Index> place;  ///< index of the primitive with a given number

    explicit Numbered(FlatScene<T> flat)
        : scene(std::move(flat)),
          place(scene.spheres.size() + scene.cones.size() + scene.triangles.size()) {
        for (std::size_t i = 0; i < place.size(); ++i)
            place[std::size_t(scene_number(Index(i)))] = Index(i);
    }
    Index scene_number(Index prim) const {
        return prim < 0 || scene.order.empty() ? prim : scene.order[std::size_t(prim)];
    }
};

/// A scene flattened without hierarchies (every primitive is tested), and with them.
template <typename T>
struct BothWays {
    Numbered<T> plain, bvh;

    explicit BothWays(const Scene& scene)
        : plain(flatten<T>(scene, all())), bvh(flatten<T>(scene)) {}

    static FlattenOptions all() {
        FlattenOptions options;
        options.hierarchies = false;
        return options;
    }
};

/// A ray that starts or ends at a critical place, in the author's numbering.
template <typename T>
ProbeRay<T> some_ray(const FlatScene<T>& scene, Random& random) {
    const auto vertex = [&]() -> glm::dvec3 {
        if (scene.triangles.empty() || random.index(8) == 0) return random.in_cube(1.2);
        const auto& triangle =
            scene.triangles[std::size_t(random.index(int(scene.triangles.size())))];
        const auto p = in_double(triangle.p0), q = in_double(triangle.p1),
                   r = in_double(triangle.p2);
        const double along = random.coin() ? 0 : random.uniform(0, 1);
        return p + along * (random.coin() ? q - p : r - p);
    };
    const int kind = random.index(8);
    glm::dvec3 origin = random.index(4) == 0 ? glm::dvec3(0) : random.in_cube(1.5);
    glm::dvec3 dir = random.unit_vector();
    if (kind == 0) dir = vertex() - origin;
    if (kind == 1) origin = vertex();
    if (kind == 2) {
        origin = vertex();
        dir = vertex() - origin;
    }
    if (kind == 3 || kind == 4) {  // parallel or perpendicular to an axis, often in a box's plane
        if (kind == 4) origin = vertex();
        for (int axis = 0; axis < 3; ++axis) {
            if (random.coin()) dir[axis] = random.coin() ? 0.0 : -0.0;
        }
    }
    if (!(glm::length(dir) > 1e-9)) dir = random.unit_vector();
    ProbeRay<T> ray{};
    const int count = int(scene.spheres.size() + scene.cones.size() + scene.triangles.size());
    ray.from = random.index(4) == 0 ? random.index(count) : Flat<T>::none;
    if (ray.from >= 0 &&
        ray.from < scene.params.sphere_count) {  // a ray from a sphere starts on it
        const auto& sphere = scene.spheres[std::size_t(ray.from)];
        const glm::dvec3 normal = random.unit_vector();
        origin = in_double(sphere.center) + double(sphere.radius) * normal;
        ray.self_hit = static_cast<T>(-2 * double(sphere.radius) * glm::dot(normal, dir));
    }
    const auto cone_index = ray.from - scene.params.sphere_count;
    if (cone_index >= 0 && cone_index < scene.params.cone_count) {  // and so does one from a cone
        const auto& cone = scene.cones[std::size_t(cone_index)];
        const double height = random.uniform(0, double(cone.length));
        const glm::dvec3 axis = in_double(cone.axis);
        const glm::dvec3 across = glm::normalize(glm::cross(axis, random.unit_vector()));
        origin = in_double(cone.base) + height * axis +
                 (double(cone.base_radius) + double(cone.slope) * height) * across;
    }
    ray.origin = pack<T>(origin);
    ray.dir = pack<T>(glm::normalize(dir));
    ray.t_max = static_cast<T>(random.uniform(0.1, 4));
    return ray;
}

}  // namespace rt
