// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "host/stress/case_helpers.h"
#include "host/stress/families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

/// A wall of 4 x 4 squares in two colors, 4 behind the origin.
void add_checkered_wall(Scene& scene) {
    const std::array<int, 2> colors{add_matt(scene, {0.875, 0.75, 0.25}),
                                    add_matt(scene, {0.125, 0.25, 0.625})};
    for (int i = 0; i < 16; ++i) {
        const double x = 2 * (i % 4) - 4, y = 2 * (i / 4) - 4;
        add_quad(scene, {x, y, -4}, {x + 2, y, -4}, {x + 2, y + 2, -4}, {x, y + 2, -4},
                 colors[static_cast<std::size_t>((i % 4 + i / 4) % 2)]);
    }
}

/// In front of a checkered wall. Even clear glass casts shadows, so the light is close to the wall.
Scene glass_scene() {
    Scene scene = bare_scene();
    set_image_size(scene, 80, 60);
    scene.lights = {{{0.75, 1, -2.5}, glm::dvec3(0.625)}};
    set_view(scene, {0, 0.25, 5}, {0, 0, 0}, 40);
    add_checkered_wall(scene);
    return scene;
}

/// A glass ball and a glass box of this index.
Scene of_index(double ior) {
    Scene scene = glass_scene();
    const int glass = add_glass(scene, ior, 1);
    add_sphere(scene, {-1, 0, 0}, 1, glass);
    add_box(scene, {0.25, -0.75, -0.5}, {1.5, 0.75, 0.5}, glass);
    return scene;
}

/// A ray leaving glass of index n has n times the sine of the angle inside: rounding grows n-fold.
StressFamily indices() {
    StressFamily family{"index",
                        "index of refraction",
                        "eta (cos i) - cos t cancels near 1, and large indices magnify rounding",
                        {}};
    for (const double ior : {1.0, 1 - 1e-7, 1 + 1e-7, 1 + 1e-3, 1.5, 2.4, 1e3, 0.5, 1e-3}) {
        StressCase one = picture_case(fmt::format("{:.8g}", ior), ior,
                                      quick_if(ior == 1 || ior == 1 + 1e-7 || ior == 1.5),
                                      [ior] { return of_index(ior); });
        if (ior == 1) std::get<PictureTrial>(one.trial).reference_scene = glass_scene;
        if (ior == 1e3) one.tolerance.max_error = 1e-3;
        family.cases.push_back(std::move(one));
    }
    return family;
}

/// The eye inside a glass object, where beyond the critical angle everything is reflected.
Scene inside_glass(double ior, bool ball) {
    Scene scene = glass_scene();
    scene.max_bounces = 6;
    const int glass = add_glass(scene, ior, 0.9375, 0, 0.0625);
    if (ball) {
        add_sphere(scene, {0, 0, 0}, 2, glass);
    } else {
        add_box(scene, {-2, -2, -2}, {2, 2, 2}, glass);
    }
    add_sphere(scene, {-0.5, -0.5, -1}, 0.5, add_matt(scene, {0.875, 0.25, 0.125}));
    set_view(scene, {0.25, 0.5, 1}, {0, 0, -1}, 110);
    return scene;
}

StressFamily inside_of_glass() {
    StressFamily family{"inside-glass",
                        "body and index",
                        "1 - eta^2 sin^2 is negative by rounding, or not where it should be",
                        {}};
    const auto add = [&](const char* label, InQuick quick, double ior, bool ball) {
        family.cases.push_back(picture_case(label, static_cast<double>(family.cases.size()), quick,
                                            [=] { return inside_glass(ior, ball); }));
    };
    add("ball-1.5", InQuick::yes, 1.5, true);
    add("ball-2.4", InQuick::no, 2.4, true);
    add("box-1.5", InQuick::yes, 1.5, false);
    add("box-2.4", InQuick::no, 2.4, false);
    add("ball-1.0001", InQuick::no, 1.0001, true);
    return family;
}

/// A prism whose slope every ray of the picture hits from inside at the critical angle of index 1.5
/// plus `beyond`. The front faces the eye.
Scene prism(double beyond) {
    Scene scene = glass_scene();
    const double ior = 1.5, slant = std::asin(1 / ior) + beyond;
    const int glass = add_glass(scene, ior, 0.9375, 0, 0.0625);
    const double depth = 4 * std::tan(slant);
    // From the front's lower edge up to the rear of the top; 4 high, 8 wide.
    add_quad(scene, {-4, -2, 1}, {4, -2, 1}, {4, 2, 1}, {-4, 2, 1}, glass);
    add_quad(scene, {-4, -2, 1}, {-4, 2, 1 - depth}, {4, 2, 1 - depth}, {4, -2, 1}, glass);
    add_quad(scene, {-4, 2, 1}, {4, 2, 1}, {4, 2, 1 - depth}, {-4, 2, 1 - depth}, glass);
    add_floor(scene, {0, 4, 0}, 12, add_matt(scene, {0.875, 0.25, 0.125}));
    scene.materials.back().two_sided = true;
    scene.lights.push_back({{1, 3, 0}, glm::dvec3(0.625)});
    set_orthographic(scene, {0, 0, 5}, {0, 0, 0}, 3);
    return scene;
}

/// At the critical angle to within rounding, both answers are right; only NaN and differences
/// between devices are wrong.
StressFamily critical_angles() {
    StressFamily family{
        "critical-angle", "radians beyond it", "the root of what should be 0 is NaN", {}};
    for (const double beyond : {-0.1, -1e-3, -1e-5, -1e-7, 0.0, 1e-7, 1e-5, 1e-3, 0.1}) {
        StressTolerance tolerance;
        tolerance.in_float = std::fabs(beyond) >= 1e-5;
        tolerance.max_error = std::fabs(beyond) < 1e-3 ? 1e-2 : 1e-4;
        family.cases.push_back(picture_case(
            fmt::format("{:g}", beyond), beyond, quick_if(beyond == 0 || beyond == 1e-5),
            [beyond] { return prism(beyond); }, tolerance,
            beyond == 0 ? ReferenceKind::none : ReferenceKind::quad));
    }
    return family;
}

/// Nested glass balls; each surface refracts as if air were outside.
Scene nested_glass(int bounces, double mirror) {
    Scene scene = glass_scene();
    scene.max_bounces = bounces;
    const int glass = add_glass(scene, 1.125, 1 - mirror, mirror);
    const int balls = bounces / 2;
    for (int i = 0; i < balls; ++i) {
        add_sphere(scene, {0, 0, 0.25 * i / balls}, 1.75 - 1.5 * i / balls, glass);
    }
    return scene;
}

/// Every ball magnifies the rounding errors of the ones before it.
StressFamily glass_depths() {
    StressFamily family{
        "glass-depth", "bounces", "every surface magnifies the rounding of those before it", {}};
    for (const int bounces : {2, 4, 8, 16, 64}) {
        StressTolerance tolerance;
        if (bounces > 8) tolerance.max_error = 1e-3;
        family.cases.push_back(picture_case(
            fmt::format("{}", bounces), bounces, quick_if(bounces == 8),
            [=] { return nested_glass(bounces, 0); }, tolerance));
    }
    return family;
}

/// The ray tree: every surface reflects and transmits. In the deepest tree, few branches matter.
StressFamily glass_trees() {
    StressFamily family{"glass-tree",
                        "bounces",
                        "trees of rays outgrow their stack, or lose the branches that wait on it",
                        {}};
    for (const int bounces : {4, 8, 16}) {
        family.cases.push_back(
            picture_case(fmt::format("{}", bounces), bounces, quick_if(bounces == 4), [=] {
                Scene scene = nested_glass(bounces, bounces > 8 ? 1e-5 : 0.125);
                set_image_size(scene, 32, 24);
                return scene;
            }));
    }
    return family;
}

/// A bar of glass that carries the view along by total reflection.
Scene light_pipe(int bounces) {
    Scene scene = glass_scene();
    scene.max_bounces = bounces;
    const int glass = add_glass(scene, 1.5, 1);
    add_box(scene, {-1, -1, -4096}, {1, 1, 4096}, glass);
    add_sphere(scene, {0.25, -0.25, -3}, 0.5, add_matt(scene, {0.875, 0.25, 0.125}));
    scene.lights = {{{0, 0.5, 1}, glm::dvec3(0.625)}};
    set_view(scene, {-0.25, 0.5, 1.5}, {1, 0.125, -0.5}, 90);
    return scene;
}

StressFamily light_pipes() {
    StressFamily family{"light-pipe",
                        "bounces",
                        "total reflection that loses a little light at each bounce, or leaks",
                        {}};
    for (const int bounces : {8, 64, 1000}) {
        family.cases.push_back(picture_case(
            fmt::format("{}", bounces), bounces, quick_if(bounces == 8),
            [=] { return light_pipe(bounces); }, {},
            bounces == 8 ? ReferenceKind::quad : ReferenceKind::extended));
    }
    return family;
}

/// All light comes from the background, and glass whose weights add up to 1 must not add to it.
Scene lit_by_background(double mirror) {
    Scene scene = bare_scene();
    set_image_size(scene, 80, 60);
    scene.lights.clear();
    scene.ambient_light = glm::dvec3(0);
    scene.background = {0.5, 0.25, 0.75};
    scene.max_bounces = 6;
    const int glass = add_glass(scene, 1.5, 1 - mirror, mirror);
    add_sphere(scene, {-1.25, 0.75, 0}, 1, glass);
    add_sphere(scene, {-1, 0.75, 0.25}, 0.5, glass);
    add_box(scene, {0.5, 0, -1}, {2, 1.5, 0.5}, glass);
    add_cone(scene, {0, 0, 2}, 0.5, {0.5, 1.5, 2}, 0.25, glass);
    return scene;
}

StressFamily glass_energy() {
    StressFamily family{"glass-energy",
                        "share that is mirrored",
                        "light that is counted twice where it splits, or where all of it turns",
                        {}};
    for (const double mirror : {0.0, 0.01, 0.25, 0.5, 0.99}) {
        family.cases.push_back(picture_case(fmt::format("{:g}", mirror), mirror,
                                            quick_if(mirror == 0.25),
                                            [mirror] { return lit_by_background(mirror); }));
    }
    return family;
}

}  // namespace

void add_glass_families(StressFamilies& families) {
    for (const auto make : {indices, inside_of_glass, critical_angles, glass_depths, glass_trees,
                            light_pipes, glass_energy}) {
        families.push_back(make());
    }
}

}  // namespace rt
