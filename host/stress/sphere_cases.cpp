// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "host/stress/families.h"
#include "host/stress/shape_families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

/// A ball of this radius, 1 away, filling half of the picture; or the eye inside it.
Scene sized_ball(double radius) {
    const double half_angle = radius < 1 ? 2 * std::asin(radius) : 0.5;
    Scene scene = shape_scene(degrees(2 * half_angle));
    add_sphere(scene, {0, 0, 0}, radius, 0);
    return scene;
}

/// Balls on the top of a ground ball, the eye 2 above it.
Scene ball_floor(double radius) {
    Scene scene = bare_scene();
    const int ground = add_matt(scene, glm::dvec3(0.5), 0.125, 10);
    scene.materials.back().mirror = glm::dvec3(0.125);
    const int red = add_matt(scene, {0.875, 0.25, 0.125});
    const int mirror = add_mirror(scene, 0.75);
    set_view(scene, {0, 2, 8}, {0, 0.75, 0}, 40);
    add_sphere(scene, {0, -radius, 0}, radius, ground);
    add_sphere(scene, {-1.25, 1, 0}, 1, red);
    add_sphere(scene, {1, 0.75, 0.5}, 0.75, mirror);
    add_sphere(scene, {2.5, 0.5, 2}, 0.5, red);
    return scene;
}

StressFamily sphere_sizes() {
    return size_family("sphere-size", "b^2 - 4 a c cancels for small and for large balls", 0.75,
                       sized_ball);
}

StressFamily floors() {
    return sweep(
        {"ball-floor", "radius of the ground", "a ground ball somewhat larger than the scene"},
        {4, 16, 64, 100}, {64}, ball_floor);
}

StressFamily huge_floors() {
    return sweep({"huge-ball-floor", "radius of the ground",
                  "r^2 - l^2 loses all digits where the ground ball is huge"},
                 {1e3, 1e4, 1e5, 1e6, 1e7, 1e8}, {1e5}, ball_floor);
}

}  // namespace

StressFamilies sphere_families() { return {sphere_sizes(), floors(), huge_floors()}; }

}  // namespace rt
