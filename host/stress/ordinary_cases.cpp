// SPDX-License-Identifier: Apache-2.0
#include <numeric>
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

struct SceneDice {
    std::mt19937 engine;
    std::uniform_real_distribution<double> from_0_to_1{0, 1};

    double unit() { return from_0_to_1(engine); }
    double number(double low, double high) { return low + (high - low) * unit(); }
    glm::dvec3 point(double half) {
        const double x = number(-half, half), y = number(-half, half);
        return {x, y, number(-half, half)};
    }
};

/// Balls and triangles of many sizes about the origin, in random colors.
Scene random_scene(unsigned seed) {
    SceneDice dice{std::mt19937(seed)};
    Scene scene = bare_scene();
    set_image_size(scene, 80, 60);
    set_view(scene, {0.3, 1.1, 7.7}, dice.point(0.5), dice.number(30, 70));
    scene.lights.push_back({dice.point(6), glm::dvec3(dice.number(0, 0.5))});
    for (int i = 0; i < 10; ++i) {
        const int material = add_matt(scene, {dice.unit(), dice.unit(), dice.unit()},
                                      dice.number(0, 1), std::exp(dice.number(0, 8)));
        scene.materials.back().mirror = glm::dvec3(i % 3 == 0 ? dice.number(0, 0.8) : 0);
        scene.materials.back().two_sided = i % 2 == 0;
        add_sphere(scene, dice.point(2.5), std::exp(dice.number(-4, 0)), material);
        const glm::dvec3 corner = dice.point(3);
        const double size = std::exp(dice.number(-3, 1));
        const glm::dvec3 b = corner + size * dice.point(1);
        add_triangle(scene, corner, b, corner + size * dice.point(1), material);
    }
    return scene;
}

/// The same with cones and glass, some of it reflective.
Scene random_glass_scene(unsigned seed) {
    Scene scene = random_scene(seed);
    SceneDice dice{std::mt19937(1000 + seed)};
    for (std::size_t i = 0; i < scene.materials.size(); i += 3) {
        Scene::Material& material = scene.materials[i];
        material.transmission = glm::dvec3(dice.number(0.25, 0.75));
        material.ior = std::exp(dice.number(-0.5, 1));
        material.diffuse *= 0.25;
    }
    for (int i = 0; i < 10; ++i) {
        const glm::dvec3 base = dice.point(2.5);
        const double size = std::exp(dice.number(-3, 0.5)), kind = dice.unit();
        const double base_radius = size * dice.number(0.1, 1);
        const double apex_radius = kind < 0.4 ? 0 : (kind < 0.7 ? base_radius : size * dice.unit());
        add_cone(scene, base, base_radius, base + size * dice.point(2), apex_radius, i);
    }
    return scene;
}

StressFamily ordinary() {
    return listed({"ordinary", "scene", "baseline: float error in an ordinary scene"},
                  {{"still-life", InQuick::yes, picture_case(still_life)},
                   {"still-life-2x2", InQuick::no, picture_case(fine_still_life)},
                   {"glass-still-life", InQuick::yes, picture_case(glass_still_life)}},
                  1);
}

StressFamily random_scenes() {
    std::vector<int> seeds(48);
    std::iota(seeds.begin(), seeds.end(), 1);
    return sweep({"random-scenes", "seed", "random shapes: touching, crossing, tiny, huge"}, seeds,
                 {1, 2, 3, 25, 26}, [](int seed) {
                     return seed <= 24 ? random_scene(seed) : random_glass_scene(seed);
                 });
}

}  // namespace

StressFamilies ordinary_families() { return {ordinary(), random_scenes()}; }

}  // namespace rt
