// SPDX-License-Identifier: Apache-2.0
#include "host/stress/case_helpers.h"
#include "host/stress/families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

/// Two facing mirror walls, 8192 wide, with a ball between them; reflections repeat up to the
/// bounce limit.
Scene facing_mirrors(double mirror, double ambient, int bounces, int width, int height) {
    Scene scene = bare_scene();
    set_image_size(scene, width, height);
    scene.max_bounces = bounces;
    const int glass = add_mirror(scene, mirror, ambient);
    const int red = add_matt(scene, {0.875, 0.25, 0.125});
    const double w = 4096;
    add_quad(scene, {-2, -w, w}, {-2, -w, -w}, {-2, w, -w}, {-2, w, w}, glass);
    add_quad(scene, {2, -w, -w}, {2, -w, w}, {2, w, w}, {2, w, -w}, glass);
    add_sphere(scene, {0.25, -0.25, -1}, 0.75, red);
    set_view(scene, {-1.25, 0.5, 1.5}, {0.25, 0.125, -0.5}, 60);
    scene.lights = {{{0, 3, 2}, glm::dvec3(0.5)}};
    return scene;
}

StressFamily mirror_walls() {
    return sweep({"facing-mirrors", "mirror rays", "every bounce adds its rounding to the next"},
                 {8, 64, 1000}, {64}, [](int bounces) {
                     StressTolerance tolerance;
                     if (bounces == 1000) tolerance.max_error = 2e-4;
                     return picture_case(
                         [=] { return facing_mirrors(1, 0, bounces, 80, 60); }, tolerance,
                         bounces == 8 ? ReferenceKind::quad : ReferenceKind::extended);
                 });
}

/// The eye inside a mirror ball, off its center, with a lit ball next to it.
Scene mirror_ball(int bounces) {
    Scene scene = bare_scene();
    set_image_size(scene, 80, 60);
    scene.max_bounces = bounces;
    const int glass = add_mirror(scene, 0.9375, 0.0625);
    const int red = add_matt(scene, {0.875, 0.25, 0.125});
    add_sphere(scene, {0, 0, 0}, 4, glass);
    add_sphere(scene, {0.5, -1, -1.5}, 0.75, red);
    scene.lights = {{{0, 2, 1}, glm::dvec3(0.5)}};
    set_view(scene, {0.25, 0.5, 1.75}, {0, 0, -1}, 60);
    return scene;
}

/// A mirror ball spreads rays by a factor per bounce; where it does, the reference changes too.
StressFamily mirror_balls() {
    return sweep({"in-mirror-ball", "mirror rays",
                  "the enclosing ball is missed, and repeated reflections jitter"},
                 {4, 16, 64}, {4}, mirror_ball);
}

Scene bright_walls(double mirror) {
    Scene scene = facing_mirrors(mirror, 0x1p-10, 1000, 32, 24);
    scene.background = {0, 0.5, 0};
    return scene;
}

StressFamily bright_mirrors() {
    return sweep({"bright-mirrors", "reflectance",
                  "light that grows at each bounce overflows, and infinity times 0 is NaN"},
                 {1.0, 1.5, 1e3, 1e30}, {1.0, 1.5, 1e30}, [](double mirror) {
                     StressTolerance tolerance;
                     tolerance.may_overflow = true;
                     tolerance.max_error = 1e-3;
                     return picture_case([=] { return bright_walls(mirror); }, tolerance,
                                         ReferenceKind::extended);
                 });
}

}  // namespace

StressFamilies mirror_families() { return {mirror_walls(), mirror_balls(), bright_mirrors()}; }

}  // namespace rt
