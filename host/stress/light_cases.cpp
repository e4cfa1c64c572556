// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "host/stress/families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

/// Two facing mirror walls, 8192 wide, with a ball between them; reflections repeat up to the
/// bounce limit.
Scene facing_mirrors(double mirror, double ambient, int bounces, int width, int height) {
    Scene scene = bare_scene(width, height);
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

/// The eye inside a mirror ball, off its center, with a lit ball next to it.
Scene mirror_ball(int bounces) {
    Scene scene = bare_scene(80, 60);
    scene.max_bounces = bounces;
    const int glass = add_mirror(scene, 0.9375, 0.0625);
    const int red = add_matt(scene, {0.875, 0.25, 0.125});
    add_sphere(scene, {0, 0, 0}, 4, glass);
    add_sphere(scene, {0.5, -1, -1.5}, 0.75, red);
    scene.lights = {{{0, 2, 1}, glm::dvec3(0.5)}};
    set_view(scene, {0.25, 0.5, 1.75}, {0, 0, -1}, 60);
    return scene;
}

Scene bright_walls(double mirror) {
    Scene scene = facing_mirrors(mirror, 0x1p-10, 1000, 32, 24);
    scene.background = {0, 0.5, 0};
    return scene;
}

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
    Scene scene = bare_scene(80, 60);
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

/// All light comes from the background, and glass whose weights add up to 1 must not add to it.
Scene lit_by_background(double mirror) {
    Scene scene = bare_scene(80, 60);
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

/// A tube, open at both ends, over a floor.
Scene lit_tube(glm::dvec3 light) {
    Scene scene = still_life();
    scene.spheres.clear();
    for (auto& material : scene.materials) material.two_sided = true;
    add_cone(scene, {0, 0.25, -1}, 1.25, {0, 2.75, -1}, 1.25, 0);
    scene.lights = {{light, glm::dvec3(0.625)}};
    return scene;
}

/// A cone over a floor, the light at its tip.
Scene lit_from_a_tip() {
    Scene scene = bare_scene();
    add_floor(scene, {0, -1, 0}, 12, add_matt(scene, glm::dvec3(0.5)));
    const int red = add_matt(scene, {0.875, 0.25, 0.125}, 0);
    for (auto& material : scene.materials) material.two_sided = true;
    add_cone(scene, {0.5, -1, 0}, 0.84375, {0.5, 0.015625, 0}, 0, red);
    scene.lights = {{{0.5, 0.015625, 0}, glm::dvec3(0.625)}};
    set_view(scene, {0, 6, 6}, {0, -1, 0}, 40);
    return scene;
}

/// Lights of 1e-30 to 1e30 shine on materials that scale them back to the visible range.
Scene stiff_light(double stiffness) {
    Scene scene = still_life();
    const double weak = 1 / stiffness;
    scene.lights = {{{-3, 6, 4}, glm::dvec3(stiffness)},
                    {{5, 4, 2}, glm::dvec3(weak)},
                    {{0, 5, 5}, glm::dvec3(0.25)}};
    for (auto& material : scene.materials) {
        material.diffuse *= 0.5 * weak;
        material.specular *= 0.5 * weak;
    }
    scene.materials.front().diffuse = glm::dvec3(0.5);
    scene.materials.front().specular = glm::dvec3(0);
    return scene;
}

Scene with_shininess(double shininess) {
    Scene scene = still_life();
    for (auto& material : scene.materials) material.shininess = shininess;
    return scene;
}

/// The center of a highlight, as wide as the picture.
Scene highlight(double shininess) {
    Scene scene = bare_scene();
    const int shiny = add_matt(scene, glm::dvec3(0.125), 0.75, shininess);
    scene.lights = {{{0, 0, 8}, glm::dvec3(1)}};
    add_sphere(scene, {0, 0, 0}, 1, shiny);
    const double degrees = 60 / std::sqrt(shininess);
    set_view(scene, {0, 0.0625, 8}, {0, 0.0625 / 16, 1}, std::min(20.0, degrees));
    return scene;
}

/// A light below, in or above the plane of a floor.
Scene grazed_plane(double height) {
    Scene scene = bare_scene(80, 60);
    const int shiny = add_matt(scene, glm::dvec3(0.25), 0.5, 0.5);
    add_floor(scene, {0, 0, 0}, 8, shiny);
    scene.lights = {{{0, height, -4}, glm::dvec3(0.5)}};
    set_view(scene, {0, 1, 6}, {0, 0, 0}, 40);
    return scene;
}

}  // namespace

StressFamilies glass_families() {
    const auto in_ball = [](double ior) { return picture_case(inside_glass(ior, true)); };
    const auto in_box = [](double ior) { return picture_case(inside_glass(ior, false)); };
    const auto for_bounces = [](int bounces) {
        return bounces == 8 ? ReferenceKind::quad : ReferenceKind::extended;
    };
    return {
        sweep({"facing-mirrors", "mirror rays", "every bounce adds its rounding to the next"},
              {8, 64, 1000}, {64},
              [=](int bounces) {
                  return picture_case(facing_mirrors(1, 0, bounces, 80, 60),
                                      {.max_error = bounces == 1000 ? 2e-4 : usual_error},
                                      for_bounces(bounces));
              }),
        // A mirror ball spreads rays by a factor per bounce; where it does, the reference changes
        // too.
        sweep({"in-mirror-ball", "mirror rays",
               "the enclosing ball is missed, and repeated reflections jitter"},
              {4, 16, 64}, {4}, mirror_ball),
        sweep({"bright-mirrors", "reflectance",
               "light that grows at each bounce overflows, and infinity times 0 is NaN"},
              {1.0, 1.5, 1e3, 1e30}, {1.0, 1.5, 1e30},
              [](double mirror) {
                  return picture_case(bright_walls(mirror),
                                      {.max_error = 1e-3, .may_overflow = true},
                                      ReferenceKind::extended);
              }),
        // A ray leaving glass of index n has n times the sine of the angle inside: rounding grows
        // n-fold.
        sweep({"index", "index of refraction",
               "eta (cos i) - cos t cancels near 1, and large indices magnify rounding"},
              {1.0, 1 - 1e-7, 1 + 1e-7, 1 + 1e-3, 1.5, 2.4, 1e3, 0.5, 1e-3}, {1, 1 + 1e-7, 1.5},
              [](double ior) {
                  StressCase one = picture_case(of_index(ior));
                  if (ior == 1) one = seen_as(glass_scene(), one);
                  if (ior == 1e3) one.tolerance.max_error = 1e-3;
                  return labeled(fmt::format("{:.8g}", ior), ior, one);
              }),
        listed({"inside-glass", "body and index",
                "1 - eta^2 sin^2 is negative by rounding, or not where it should be"},
               {{"ball-1.5", quick(in_ball(1.5))},
                {"ball-2.4", in_ball(2.4)},
                {"box-1.5", quick(in_box(1.5))},
                {"box-2.4", in_box(2.4)},
                {"ball-1.0001", in_ball(1.0001)}}),
        // At the critical angle to within rounding, both answers are right; only NaN and
        // differences between devices are wrong.
        sweep({"critical-angle", "radians beyond it", "the square root of what should be 0 is NaN"},
              {-0.1, -1e-3, -1e-5, -1e-7, 0.0, 1e-7, 1e-5, 1e-3, 0.1}, {0, 1e-5},
              [](double beyond) {
                  const double off = std::fabs(beyond);
                  return picture_case(
                      prism(beyond),
                      {.max_error = off < 1e-3 ? 1e-2 : usual_error, .in_float = off >= 1e-5},
                      off == 0 ? ReferenceKind::none : ReferenceKind::quad);
              }),
        // Every ball magnifies the rounding errors of the ones before it.
        sweep({"glass-depth", "bounces",
               "each surface magnifies the rounding errors of the previous ones"},
              {2, 4, 8, 16, 64}, {8},
              [](int bounces) {
                  return picture_case(nested_glass(bounces, 0),
                                      {.max_error = bounces > 8 ? 1e-3 : usual_error});
              }),
        // The ray tree: every surface reflects and transmits. In the deepest tree, few branches
        // matter.
        sweep({"glass-tree", "bounces", "ray trees overflow their stack or lose branches"},
              {4, 8, 16}, {4},
              [](int bounces) {
                  Scene scene = nested_glass(bounces, bounces > 8 ? 1e-5 : 0.125);
                  set_image_size(scene, 32, 24);
                  return scene;
              }),
        sweep({"light-pipe", "bounces",
               "total reflection that loses a little light at each bounce, or leaks"},
              {8, 64, 1000}, {8},
              [=](int bounces) {
                  return picture_case(light_pipe(bounces), {}, for_bounces(bounces));
              }),
        sweep({"glass-energy", "share that is mirrored",
               "light counted twice where it splits or is totally reflected"},
              {0.0, 0.01, 0.25, 0.5, 0.99}, {0.25}, lit_by_background)};
}

StressFamilies light_families() {
    const auto tube = [](glm::dvec3 light) { return picture_case(lit_tube(light)); };
    const auto lit_by = [](std::vector<Scene::Light> lights) {
        Scene scene = still_life();
        scene.lights = lights;
        return picture_case(scene);
    };
    const auto at = [=](glm::dvec3 position) { return lit_by({{position, glm::dvec3(0.625)}}); };
    return {
        listed({"light-place", "where the light is",
                "a light on a surface is shadowed by that surface, or shines through it"},
               {{"on-the-floor", quick(at({1, 0, 4}))},
                {"2^-10-above-the-floor", at({1, 0x1p-10, 4})},
                {"2^-20-above-the-floor", at({1, 0x1p-20, 4})},
                {"on-a-ball", quick(at({-1.5, 2, 0}))},
                {"in-a-ball", at({-1.5, 1.25, 0})},
                {"on-a-tube", quick(tube({0.75, 1.5, 0}))},
                {"on-a-tubes-rim", tube({-0.75, 2.75, 0})},
                {"in-a-tube", tube({0.25, 1.5, -1})},
                {"1e-9-off-a-ball", quick(at({-1.5, 2 + 1e-9, 0}))},
                {"1e-9-in-a-ball", quick(at({-1.5, 2 - 1e-9, 0}))},
                {"1e-9-off-a-tube", quick(tube({0.75 + 6e-10, 1.5, 8e-10}))},
                {"1e-9-in-a-tube", quick(tube({0.75 - 6e-10, 1.5, -8e-10}))},
                {"at-a-cones-tip", quick(picture_case(lit_from_a_tip()))},
                {"at-the-eye", quick(at({0, 2, 8}))},
                {"1e5-away", at({-6e4, 8e4, 1e4})},
                {"1e7-away", at({-6e6, 8e6, 1e6})},
                {"1e9-away", quick(at({-6e8, 8e8, 1e8}))},
                {"below-the-floor", at({0, -4, 0})},
                {"none", quick(lit_by({}))}}),
        sweep({"stiff-light", "brightest over faintest",
               "sums and products of light leave the range of float"},
              {1e3, 1e6, 1e15, 1e30}, {1e30},
              [](double stiffness) {
                  return labeled(fmt::format("1e{:.0f}", 2 * std::log10(stiffness)),
                                 stiffness * stiffness, picture_case(stiff_light(stiffness)));
              }),
        sweep({"shininess", "exponent",
               "pow(0, 0), pow of what rounding made negative, and pow near 1"},
              {0.0, 1e-30, 1e-3, 1.0, 1e2, 1e4, 1e6, 1e30}, {0, 1e-3, 1e6}, with_shininess),
        sweep(
            {"highlight", "exponent", "pow(dot(n, h), e) turns an ulp of n.h into e ulps of light"},
            {1e2, 1e3, 1e4, 1e5, 1e6}, {1e4, 1e6},
            [](double e) {
                return picture_case(highlight(e), {.max_error = e > 1e4 ? 1e-3 : usual_error});
            }),
        // Blinn highlights start at full strength at the horizon: where the light is above it
        // by less than rounding, both answers are right; only NaN and differences between
        // devices are wrong.
        sweep({"grazing-light", "height of the light", "n.h negative, 0 or subnormal"},
              {-1.0, -1e-30, 0.0, 1e-300, 1e-40, 1e-20, 1e-10, 1e-3, 1e-2}, {0, 1e-40},
              [](double height) {
                  const bool clear = height <= 0 || height >= 1e-3;
                  return picture_case(grazed_plane(height), {},
                                      clear ? ReferenceKind::quad : ReferenceKind::none);
              })};
}

}  // namespace rt
