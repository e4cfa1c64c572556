// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "host/stress/families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

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
    Scene scene = bare_scene();
    set_image_size(scene, 80, 60);
    const int shiny = add_matt(scene, glm::dvec3(0.25), 0.5, 0.5);
    add_floor(scene, {0, 0, 0}, 8, shiny);
    scene.lights = {{{0, height, -4}, glm::dvec3(0.5)}};
    set_view(scene, {0, 1, 6}, {0, 0, 0}, 40);
    return scene;
}

}  // namespace

StressFamilies light_families() {
    const auto tube = [](glm::dvec3 light) {
        return picture_case([=] { return lit_tube(light); });
    };
    const auto lit_by = [](std::vector<Scene::Light> lights) {
        return picture_case(still_life_with([=](Scene& scene) { scene.lights = lights; }));
    };
    const auto at = [=](glm::dvec3 position) { return lit_by({{position, glm::dvec3(0.625)}}); };
    return {listed({"light-place", "where the light is",
                    "a light on a surface is shadowed by that surface, or shines through it"},
                   {{"on-the-floor", InQuick::yes, at({1, 0, 4})},
                    {"2^-10-above-the-floor", InQuick::no, at({1, 0x1p-10, 4})},
                    {"2^-20-above-the-floor", InQuick::no, at({1, 0x1p-20, 4})},
                    {"on-a-ball", InQuick::yes, at({-1.5, 2, 0})},
                    {"in-a-ball", InQuick::no, at({-1.5, 1.25, 0})},
                    {"on-a-tube", InQuick::yes, tube({0.75, 1.5, 0})},
                    {"on-a-tubes-rim", InQuick::no, tube({-0.75, 2.75, 0})},
                    {"in-a-tube", InQuick::no, tube({0.25, 1.5, -1})},
                    {"1e-9-off-a-ball", InQuick::yes, at({-1.5, 2 + 1e-9, 0})},
                    {"1e-9-in-a-ball", InQuick::yes, at({-1.5, 2 - 1e-9, 0})},
                    {"1e-9-off-a-tube", InQuick::yes, tube({0.75 + 6e-10, 1.5, 8e-10})},
                    {"1e-9-in-a-tube", InQuick::yes, tube({0.75 - 6e-10, 1.5, -8e-10})},
                    {"at-a-cones-tip", InQuick::yes, picture_case(lit_from_a_tip)},
                    {"at-the-eye", InQuick::yes, at({0, 2, 8})},
                    {"1e5-away", InQuick::no, at({-6e4, 8e4, 1e4})},
                    {"1e7-away", InQuick::no, at({-6e6, 8e6, 1e6})},
                    {"1e9-away", InQuick::yes, at({-6e8, 8e8, 1e8})},
                    {"below-the-floor", InQuick::no, at({0, -4, 0})},
                    {"none", InQuick::yes, lit_by({})}}),
            sweep({"stiff-light", "brightest over faintest",
                   "sums and products of light leave the range of float"},
                  {1e3, 1e6, 1e15, 1e30}, {1e30},
                  [](double stiffness) {
                      return labeled(fmt::format("1e{:.0f}", 2 * std::log10(stiffness)),
                                     stiffness * stiffness,
                                     picture_case([=] { return stiff_light(stiffness); }));
                  }),
            sweep({"shininess", "exponent",
                   "pow(0, 0), pow of what rounding made negative, and pow near 1"},
                  {0.0, 1e-30, 1e-3, 1.0, 1e2, 1e4, 1e6, 1e30}, {0, 1e-3, 1e6}, with_shininess),
            sweep({"highlight", "exponent",
                   "pow(dot(n, h), e) turns an ulp of n.h into e ulps of light"},
                  {1e2, 1e3, 1e4, 1e5, 1e6}, {1e4, 1e6},
                  [](double e) {
                      return picture_case([=] { return highlight(e); },
                                          {.max_error = e > 1e4 ? 1e-3 : usual_error});
                  }),
            // Blinn highlights start at full strength at the horizon: where the light is above it
            // by less than rounding, both answers are right; only NaN and differences between
            // devices are wrong.
            sweep({"grazing-light", "height of the light", "n.h negative, 0 or subnormal"},
                  {-1.0, -1e-30, 0.0, 1e-300, 1e-40, 1e-20, 1e-10, 1e-3, 1e-2}, {0, 1e-40},
                  [](double height) {
                      const bool clear = height <= 0 || height >= 1e-3;
                      return picture_case([=] { return grazed_plane(height); }, {},
                                          clear ? ReferenceKind::quad : ReferenceKind::none);
                  })};
}

}  // namespace rt
