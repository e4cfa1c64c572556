// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <random>

#include "host/stress/case_helpers.h"
#include "host/stress/families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

Scene fine_still_life() {
    Scene scene = still_life();
    scene.aa.count = 2;
    set_image_size(scene, 80, 60);
    return scene;
}

/// Balls and triangles of many sizes about the origin, in random colors.
Scene random_scene(unsigned seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto number = [&](double low, double high) { return low + (high - low) * unit(engine); };
    const auto point = [&](double half) {
        const double x = number(-half, half), y = number(-half, half);
        return glm::dvec3(x, y, number(-half, half));
    };
    Scene scene = bare_scene();
    set_image_size(scene, 80, 60);
    set_view(scene, {0.3, 1.1, 7.7}, point(0.5), number(30, 70));
    scene.lights.push_back({point(6), glm::dvec3(number(0, 0.5))});
    for (int i = 0; i < 10; ++i) {
        const int material = add_matt(scene, {unit(engine), unit(engine), unit(engine)},
                                      number(0, 1), std::exp(number(0, 8)));
        scene.materials.back().mirror = glm::dvec3(i % 3 == 0 ? number(0, 0.8) : 0);
        scene.materials.back().two_sided = i % 2 == 0;
        add_sphere(scene, point(2.5), std::exp(number(-4, 0)), material);
        const glm::dvec3 corner = point(3);
        const double size = std::exp(number(-3, 1));
        const glm::dvec3 b = corner + size * point(1);
        add_triangle(scene, corner, b, corner + size * point(1), material);
    }
    return scene;
}

/// The same with cones and glass, some of it reflective.
Scene random_glass_scene(unsigned seed) {
    Scene scene = random_scene(seed);
    std::mt19937 engine(1000 + seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto number = [&](double low, double high) { return low + (high - low) * unit(engine); };
    const auto point = [&](double half) {
        const double x = number(-half, half), y = number(-half, half);
        return glm::dvec3(x, y, number(-half, half));
    };
    for (std::size_t i = 0; i < scene.materials.size(); i += 3) {
        Scene::Material& material = scene.materials[i];
        material.transmission = glm::dvec3(number(0.25, 0.75));
        material.ior = std::exp(number(-0.5, 1));
        material.diffuse *= 0.25;
    }
    for (int i = 0; i < 10; ++i) {
        const glm::dvec3 base = point(2.5);
        const double size = std::exp(number(-3, 0.5)), kind = unit(engine);
        const double base_radius = size * number(0.1, 1);
        const double apex_radius =
            kind < 0.4 ? 0 : (kind < 0.7 ? base_radius : size * unit(engine));
        add_cone(scene, base, base_radius, base + size * point(2), apex_radius, i);
    }
    return scene;
}

}  // namespace

void add_ordinary_families(StressFamilies& families) {
    families.push_back({"ordinary",
                        "scene",
                        "baseline: float error in an ordinary scene",
                        {picture_case("still-life", 1, InQuick::yes, still_life),
                         picture_case("still-life-2x2", 2, InQuick::no, fine_still_life),
                         picture_case("glass-still-life", 3, InQuick::yes, glass_still_life)}});
    StressFamily random{
        "random-scenes", "seed", "shapes that nobody chose: touching, crossing, tiny, huge", {}};
    for (unsigned seed = 1; seed <= 24; ++seed) {
        random.cases.push_back(picture_case(fmt::format("{}", seed), seed, quick_if(seed <= 3),
                                            [seed] { return random_scene(seed); }));
    }
    for (unsigned seed = 25; seed <= 48; ++seed) {
        random.cases.push_back(picture_case(fmt::format("{}", seed), seed, quick_if(seed <= 26),
                                            [seed] { return random_glass_scene(seed); }));
    }
    families.push_back(std::move(random));
}

}  // namespace rt
