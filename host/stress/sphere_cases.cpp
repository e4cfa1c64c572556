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
    const StressFamily floors =
        sweep({"huge-ball-floor", "radius of the ground",
               "r^2 - l^2 loses all precision where the ground ball is huge"},
              {1e3, 1e4, 1e5, 1e6, 1e7, 1e8}, {1e5}, ball_floor);
    return sweep(floors, {1e6}, {1e6}, [](double radius) {
        return labeled("1e+06-among-far-balls", radius, picture_case([=] {
                           Scene scene = ball_floor(radius);
                           for (int i = 0; i < 8; ++i) {
                               const glm::dvec3 way{i % 3 - 1, 0.25, i % 2 == 0 ? -1 : 1};
                               add_sphere(scene, 0.125 * radius * way, 0.005 * radius, 1);
                           }
                           return scene;
                       }));
    });
}

/// A light this high above the top of the ground, 1e8 in radius.
StressFamily ground_lights() {
    return sweep({"ground-light", "height of the light",
                  "rounding at the ground decides whether it hides a light behind it"},
                 {-5.0, -0.5, -1e-3, 1e-3, 0.5, 5.0}, {-5.0, 0.5}, [](double height) {
                     Scene scene = ball_floor(1e8);
                     for (auto& material : scene.materials) material.two_sided = true;
                     scene.lights = {{{0, height, 2}, glm::dvec3(0.75)}};
                     return scene;
                 });
}

}  // namespace

StressFamilies sphere_families() {
    return {sphere_sizes(), floors(), huge_floors(), ground_lights()};
}

}  // namespace rt
