// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "host/stress/case_helpers.h"
#include "host/stress/families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

Scene lit_from(glm::dvec3 position) {
    Scene scene = still_life();
    scene.lights = {{position, glm::dvec3(0.625)}};
    return scene;
}

StressFamily light_places() {
    StressFamily family{"light-place",
                        "where the light is",
                        "a light on a surface is shadowed by "
                        "that surface, or shines through it",
                        {}};
    const auto add = [&](const char* label, glm::dvec3 position) {
        family.cases.push_back(picture_case(label, static_cast<double>(family.cases.size()),
                                            InQuick::no, [=] { return lit_from(position); }));
    };
    add("on-the-floor", {1, 0, 4});
    add("2^-10-above-the-floor", {1, 0x1p-10, 4});
    add("2^-20-above-the-floor", {1, 0x1p-20, 4});
    add("on-a-ball", {-1.5, 2, 0});
    add("in-a-ball", {-1.5, 1.25, 0});
    add("at-the-eye", {0, 2, 8});
    add("1e5-away", {-6e4, 8e4, 1e4});
    add("1e7-away", {-6e6, 8e6, 1e6});
    add("1e9-away", {-6e8, 8e8, 1e8});
    add("below-the-floor", {0, -4, 0});
    for (const std::size_t i : {0, 3, 5, 8}) family.cases[i].quick = true;
    family.cases.push_back(
        picture_case("none", static_cast<double>(family.cases.size()), InQuick::yes, [] {
            Scene scene = still_life();
            scene.lights.clear();
            return scene;
        }));
    return family;
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

StressFamily stiff_lights() {
    StressFamily family{"stiff-light",
                        "brightest over faintest",
                        "sums and products of light "
                        "leave the range of float",
                        {}};
    for (const double stiffness : {1e3, 1e6, 1e15, 1e30}) {
        family.cases.push_back(picture_case(fmt::format("1e{:.0f}", 2 * std::log10(stiffness)),
                                            stiffness * stiffness, quick_if(stiffness == 1e30),
                                            [=] { return stiff_light(stiffness); }));
    }
    return family;
}

Scene with_shininess(double shininess) {
    Scene scene = still_life();
    for (auto& material : scene.materials) material.shininess = shininess;
    return scene;
}

StressFamily exponents() {
    StressFamily family{"shininess",
                        "exponent",
                        "pow(0, 0), pow of what rounding made negative, "
                        "and pow near 1",
                        {}};
    for (const double e : {0.0, 1e-30, 1e-3, 1.0, 1e2, 1e4, 1e6, 1e30}) {
        family.cases.push_back(picture_case(fmt::format("{:g}", e), e,
                                            quick_if(e == 0 || e == 1e-3 || e == 1e6),
                                            [e] { return with_shininess(e); }));
    }
    return family;
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

StressFamily highlights() {
    StressFamily family{"highlight",
                        "exponent",
                        "pow(dot(n, h), e) turns an ulp of n.h into e "
                        "ulps of light",
                        {}};
    for (const double e : {1e2, 1e3, 1e4, 1e5, 1e6}) {
        StressTolerance tolerance;
        tolerance.max_error = e > 1e4 ? 1e-3 : 1e-4;
        family.cases.push_back(picture_case(
            fmt::format("{:g}", e), e, quick_if(e == 1e4 || e == 1e6), [e] { return highlight(e); },
            tolerance));
    }
    return family;
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

/// n.h negative, 0 and subnormal. Blinn highlights start at full strength at the horizon: where the
/// light is above it by less than rounding, both answers are right; only NaN and differences
/// between devices are wrong.
StressFamily grazing_lights() {
    StressFamily family{"grazing-light", "height of the light", "n.h negative, 0 or subnormal", {}};
    for (const double height : {-1.0, -1e-30, 0.0, 1e-300, 1e-40, 1e-20, 1e-10, 1e-3, 1e-2}) {
        const bool clear = height <= 0 || height >= 1e-3;
        family.cases.push_back(picture_case(
            fmt::format("{:g}", height), height, quick_if(height == 0 || height == 1e-40),
            [height] { return grazed_plane(height); }, {},
            clear ? ReferenceKind::quad : ReferenceKind::none));
    }
    return family;
}

}  // namespace

void add_light_families(StressFamilies& families) {
    for (const auto make : {light_places, stiff_lights, exponents, highlights, grazing_lights}) {
        families.push_back(make());
    }
}

}  // namespace rt
