// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numeric>
#include <random>

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
    SceneDice random{std::mt19937(seed)};
    Scene scene = bare_scene();
    set_image_size(scene, 80, 60);
    set_view(scene, {0.3, 1.1, 7.7}, random.point(0.5), random.number(30, 70));
    scene.lights.push_back({random.point(6), glm::dvec3(random.number(0, 0.5))});
    for (int i = 0; i < 10; ++i) {
        const int material = add_matt(scene, {random.unit(), random.unit(), random.unit()},
                                      random.number(0, 1), std::exp(random.number(0, 8)));
        scene.materials.back().mirror = glm::dvec3(i % 3 == 0 ? random.number(0, 0.8) : 0);
        scene.materials.back().two_sided = i % 2 == 0;
        add_sphere(scene, random.point(2.5), std::exp(random.number(-4, 0)), material);
        const glm::dvec3 corner = random.point(3);
        const double size = std::exp(random.number(-3, 1));
        const glm::dvec3 b = corner + size * random.point(1);
        add_triangle(scene, corner, b, corner + size * random.point(1), material);
    }
    return scene;
}

/// The same with cones and glass, some of it reflective.
Scene random_glass_scene(unsigned seed) {
    Scene scene = random_scene(seed);
    SceneDice random{std::mt19937(1000 + seed)};
    for (std::size_t i = 0; i < scene.materials.size(); i += 3) {
        Scene::Material& material = scene.materials[i];
        material.transmission = glm::dvec3(random.number(0.25, 0.75));
        material.ior = std::exp(random.number(-0.5, 1));
        material.diffuse *= 0.25;
    }
    for (int i = 0; i < 10; ++i) {
        const glm::dvec3 base = random.point(2.5);
        const double size = std::exp(random.number(-3, 0.5)), kind = random.unit();
        const double base_radius = size * random.number(0.1, 1);
        const double apex_radius =
            kind < 0.4 ? 0 : (kind < 0.7 ? base_radius : size * random.unit());
        add_cone(scene, base, base_radius, base + size * random.point(2), apex_radius, i);
    }
    return scene;
}

StressCase same_bits(MakeScene scene) {
    StressCase one = picture_case(std::move(scene));
    std::get<PictureTrial>(one.trial).same_bits = "the scene as it is";
    return one;
}

}  // namespace

StressFamilies ordinary_families() {
    std::vector<int> seeds(48);
    std::iota(seeds.begin(), seeds.end(), 1);
    return {
        listed({"ordinary", "scene", "baseline: float error in an ordinary scene"},
               {{"still-life", InQuick::yes, picture_case(still_life)},
                {"still-life-2x2", InQuick::no, picture_case(fine_still_life)},
                {"glass-still-life", InQuick::yes, picture_case(glass_still_life)}},
               1),
        sweep({"random-scenes", "seed", "random shapes: touching, crossing, tiny, huge"}, seeds,
              {1, 2, 3, 25, 26},
              [](int seed) { return seed <= 24 ? random_scene(seed) : random_glass_scene(seed); }),
        sweep({"scale-2", "scale",
               "absolute epsilons swallow small scenes and leave holes in large ones"},
              {0, -40, -36, -32, -28, -24, -20, -16, -12, -8, -4,
               4, 8,   12,  16,  20,  24,  28,  32,  36,  40},
              {0, -40, -20, 20, 40}, [](int k) { return scaled_by_two(still_life, k); }),
        sweep({"scale-10", "scale", "squares of distances leave the range of float beyond 10^19"},
              {-30, -25, -20, -15, -10, -6, -4, -3, -2, -1, 1, 2, 3, 4, 6, 10, 15, 20, 25, 30},
              {-30, -3, 3, 30}, [](int k) { return scaled_by_ten(still_life, k); }),
        sweep({"shift", "distance from the origin",
               "coordinates far from the origin leave no precision for the scene"},
              {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {0, 5, 9},
              [](int k) {
                  if (k == 0) return labeled("0", 0, same_bits(still_life));
                  return moved(still_life, fmt::format("1e{}", k), std::pow(10.0, k));
              }),
        // Coordinates are rounded to double after the shift; the reference sees the same doubles.
        sweep({"shift-odd", "distance from the origin", "offsets that float cannot represent"},
              {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {7},
              [](int k) {
                  const double by = 1.1 * std::pow(10.0, k);
                  return labeled(fmt::format("1.1e{}", k), by, picture_case([=] {
                                     return shifted(still_life(), {by, -by / 3, by / 7});
                                 }));
              }),
        // A scene with one distant object, which must not set the scale.
        sweep({"outlier", "distance of one ball",
               "one distant object must not cost the others their precision"},
              {1e2, 1e4, 1e6, 1e9, 1e12, 1e15}, {1e9}, [](double distance) {
                  Scene scene = still_life();
                  const double radius = 0.25 * distance;
                  add_sphere(scene, {0.5 * radius, radius, -distance}, radius, 0);
                  return scene;
              })};
}

StressCase scaled_by_two(const MakeScene& scene, int k) {
    const double factor = std::ldexp(1.0, k);
    return labeled(fmt::format("2^{}", k), factor,
                   same_bits([=] { return scaled(scene(), factor); }));
}

StressCase scaled_by_ten(const MakeScene& scene, int k) {
    const double factor = std::pow(10.0, k);
    return labeled(fmt::format("10^{}", k), factor,
                   picture_case([=] { return scaled(scene(), factor); }));
}

StressCase moved(const MakeScene& scene, std::string label, double by) {
    return labeled(std::move(label), by, same_bits([=] {
                       return shifted(scene(), {by, -by, by < 5e8 ? 2 * by : by});
                   }));
}

}  // namespace rt
