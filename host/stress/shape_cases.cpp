// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>

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
    Scene scene = bare_scene(80, 60);
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

// The scene scaled or moved. The first and last of these must not change a bit of its picture.

/// By 2^k.
StressCase scaled_by_two(const Scene& scene, int k) {
    const double factor = std::ldexp(1.0, k);
    return labeled(fmt::format("2^{}", k), factor, same_bits(scaled(scene, factor)));
}

/// By 10^k.
StressCase scaled_by_ten(const Scene& scene, int k) {
    const double factor = std::pow(10.0, k);
    return labeled(fmt::format("10^{}", k), factor, picture_case(scaled(scene, factor)));
}

/// By whole numbers: `by` and up to twice that.
StressCase moved(const Scene& scene, std::string label, double by) {
    return labeled(std::move(label), by,
                   same_bits(shifted(scene, {by, -by, by < 5e8 ? 2 * by : by})));
}

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

/// A small picture of a shape to be added around the origin in material 0, which is shiny and
/// two-sided; the eye is 1 unit in front. The view is at most 120 degrees high.
Scene shape_scene(double fov_degrees) {
    Scene scene = bare_scene(80, 60);
    add_matt(scene, {0.75, 0.5, 0.25}, 0.25, 20);
    scene.materials.back().two_sided = true;
    scene.lights = {{{0.25, 0.5, 0.5}, glm::dvec3(0.5)}};
    set_view(scene, {0, 0, 1}, {0, 0, 0}, std::min(120.0, fov_degrees));
    return scene;
}

/// Rounding coordinates to float alone moves a small object by 2^-24 of its distance, which is 1.
/// Float is not judged where that is too much; double must be right there.
StressTolerance small_tolerance(double size) {
    if (size < 1e-4) return {.in_float = false};
    return {.max_error = size < 1 ? 1e-4 + 16 * 0x1p-24 / size : usual_error};
}

/// Pictures of a shape at distance 1: radii from 1e-6 to 1e6, with `middle` in place of 1.
StressFamily size_family(const char* name, const char* why, double middle,
                         Scene (*scene)(double radius)) {
    return sweep({name, "radius over distance", why},
                 {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, middle, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6},
                 {1e-4, middle, 1e4}, [=](double radius) {
                     return picture_case(scene(radius), small_tolerance(radius));
                 });
}

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

/// A frustum as long as it is wide, 1 away, half as high as the picture; or the eye inside it.
Scene sized_cone(double radius) {
    const double half_angle = radius < 1 ? 2 * std::atan(radius) : 0.5;
    Scene scene = shape_scene(degrees(2 * half_angle));
    const glm::dvec3 half = radius * glm::dvec3(0.28, 0.75, 0.6);
    add_cone(scene, -half, radius, half, 0.5 * radius, 0);
    return scene;
}

/// A tube and a cone of radius 0.25 and 0.5 that run off to the horizon, over a floor; or that come
/// from there.
Scene long_cones(double length, bool from_afar = false) {
    Scene scene = bare_scene(80, 60);
    const int red = add_matt(scene, {0.875, 0.25, 0.125}, 0.25, 20);
    const int mirror = add_mirror(scene, 0.5);
    for (auto& material : scene.materials) material.two_sided = true;
    const glm::dvec3 away(0.28, 0, -0.96);
    add_cone(scene, {-0.5, 0.5, 1}, 0.25, glm::dvec3(-0.5, 0.5, 1) + length * away, 0.25, red);
    add_cone(scene, {0.5, 0.5, 1}, 0.5, glm::dvec3(0.5, 0.5, 1) + length * away, 0, mirror);
    for (Scene::Cone& cone : scene.cones) {
        if (!from_afar) continue;
        std::swap(cone.base, cone.apex);
        std::swap(cone.base_radius, cone.apex_radius);
    }
    add_floor(scene, {0, -0.5, 0}, 12, red);
    set_view(scene, {0, 2, 5}, {0.5, 0.5, -2}, 50);
    return scene;
}

/// A needle of length 2 across a narrow view, taking up about a fifth of its height.
Scene cone_needle(double radius) {
    Scene scene = shape_scene(degrees(8 * radius));
    add_cone(scene, {-1, -0.25 * radius, -0.125}, radius, {1, 0.5 * radius, 0.25}, 0.5 * radius, 0);
    return scene;
}

/// A ring of almost no height.
Scene flat_cone(double height) {
    Scene scene = shape_scene(60);
    const glm::dvec3 axis(0.28, 0.576, 0.768);
    add_cone(scene, {0, 0, 0}, 0.5, height * axis, 0.125, 0);
    return scene;
}

/// Intersecting tubes, two of them mirrors, one seen end-on, over a floor.
Scene tubes() {
    Scene scene = still_life();
    scene.spheres.clear();
    const auto red = 0, glossy = 3, mirror = 4;
    for (auto& material : scene.materials) material.two_sided = true;
    add_cone(scene, {-2, 0.5, 1}, 0.5, {2, 0.5, 1}, 0.5, red);
    add_cone(scene, {-1, 0, -1}, 0.75, {-1.5, 3, -1}, 0.75, mirror);
    add_cone(scene, {0, 0.25, -2}, 0.375, {0, 0.75, 3}, 0.375, glossy);
    add_cone(scene, {2.5, 0.125, 3}, 0.5, {2.5, 1.125, 3}, 0.5, mirror);
    return scene;
}

/// A small picture of the scene as it is, scaled and moved.
StressFamily scaled_and_moved(const char* name, const char* why, Scene small) {
    set_image_size(small, 80, 60);
    StressFamily family =
        sweep({name, "scale, or distance from the origin", why}, {0, -40, -20, 20, 40}, {0, -40},
              [=](int k) { return scaled_by_two(small, k); });
    family.cases.front().label = "as-it-is";
    family = sweep(family, {-30, -15, -6, -3, 3, 6, 15, 30}, {},
                   [=](int k) { return scaled_by_ten(small, k); });
    return sweep(family, {1e3, 1e6, 1e9}, {1e6},
                 [=](double by) { return moved(small, fmt::format("moved-{:g}", by), by); });
}

/// A frustum this far from the eye.
Scene cone_to_aim_at(double radius, double distance) {
    return scene_to_aim_at(distance, [=](Scene& scene, const glm::dvec3& middle) {
        const glm::dvec3 half = radius * glm::dvec3(0.8, 0, -0.6);
        add_cone(scene, middle - half, radius, middle + half, 0.375 * radius, 0);
    });
}

/// Rays that stay near the surface along a generator hit it again at a distance that grows without
/// bound, so inward angles start at 0.01 rad; far away, where points are rounded more, at 0.1.
StressFamily leaving_cones(const char* name, double distances, const char* why) {
    const bool is_far = distances > 10;
    const double shallowest = is_far ? 0.1 : 0.01;
    return leaving_family(name, why, is_far ? 1e-2 : 1e-3, [=](double radius) {
        return leaving_cone(cone_to_aim_at(radius, distances * radius), shallowest);
    });
}

}  // namespace

StressFamilies ordinary_families() {
    std::vector<int> seeds(48);
    std::iota(seeds.begin(), seeds.end(), 1);
    return {
        listed({"ordinary", "scene", "baseline: float error in an ordinary scene"},
               {{"still-life", quick(picture_case(still_life()))},
                {"still-life-2x2", picture_case(fine_still_life())},
                {"glass-still-life", quick(picture_case(glass_still_life()))}}),
        sweep({"random-scenes", "seed", "random shapes: touching, crossing, tiny, huge"}, seeds,
              {1, 2, 3, 25, 26},
              [](int seed) { return seed <= 24 ? random_scene(seed) : random_glass_scene(seed); }),
        sweep({"scale-2", "scale",
               "absolute epsilons swallow small scenes and leave holes in large ones"},
              {0, -40, -36, -32, -28, -24, -20, -16, -12, -8, -4,
               4, 8,   12,  16,  20,  24,  28,  32,  36,  40},
              {0, -40, -20, 20, 40}, [](int k) { return scaled_by_two(still_life(), k); }),
        sweep({"scale-10", "scale", "squares of distances leave the range of float beyond 10^19"},
              {-30, -25, -20, -15, -10, -6, -4, -3, -2, -1, 1, 2, 3, 4, 6, 10, 15, 20, 25, 30},
              {-30, -3, 3, 30}, [](int k) { return scaled_by_ten(still_life(), k); }),
        sweep({"shift", "distance from the origin",
               "coordinates far from the origin leave no precision for the scene"},
              {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {0, 5, 9},
              [](int k) {
                  if (k == 0) return labeled("0", 0, same_bits(still_life()));
                  return moved(still_life(), fmt::format("1e{}", k), std::pow(10.0, k));
              }),
        // Coordinates are rounded to double after the shift; the reference sees the same doubles.
        sweep({"shift-odd", "distance from the origin", "offsets that float cannot represent"},
              {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {7},
              [](int k) {
                  const double by = 1.1 * std::pow(10.0, k);
                  return labeled(fmt::format("1.1e{}", k), by,
                                 picture_case(shifted(still_life(), {by, -by / 3, by / 7})));
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

StressFamilies shape_families() {
    const StressFamily huge_floors =
        sweep({"huge-ball-floor", "radius of the ground",
               "r^2 - l^2 loses all precision where the ground ball is huge"},
              {1e3, 1e4, 1e5, 1e6, 1e7, 1e8}, {1e5}, ball_floor);
    const StressFamily long_cones_away = sweep(
        {"long-cone", "length over radius", "the far end's magnitudes swamp the near end's"},
        {4e1, 4e2, 4e4, 4e6, 4e8}, {4e2, 4e6}, [](double ratio) { return long_cones(ratio / 4); });
    return {size_family("sphere-size", "b^2 - 4 a c cancels for small and for large balls", 0.75,
                        sized_ball),
            sweep({"ball-floor", "radius of the ground",
                   "a ground ball somewhat larger than the scene"},
                  {4, 16, 64, 100}, {64}, ball_floor),
            sweep(huge_floors, {1e6}, {1e6},
                  [](double radius) {
                      Scene scene = ball_floor(radius);
                      for (int i = 0; i < 8; ++i) {
                          const glm::dvec3 way{i % 3 - 1, 0.25, i % 2 == 0 ? -1 : 1};
                          add_sphere(scene, 0.125 * radius * way, 0.005 * radius, 1);
                      }
                      return labeled("1e+06-among-far-balls", radius, picture_case(scene));
                  }),
            // A light this high above the top of the ground, 1e8 in radius.
            sweep({"ground-light", "height of the light",
                   "rounding at the ground decides whether it hides a light behind it"},
                  {-5.0, -0.5, -1e-3, 1e-3, 0.5, 5.0}, {-5.0, 0.5},
                  [](double height) {
                      Scene scene = ball_floor(1e8);
                      for (auto& material : scene.materials) material.two_sided = true;
                      scene.lights = {{{0, height, 2}, glm::dvec3(0.75)}};
                      return scene;
                  }),
            size_family("cone-size", "the quadratic's terms cancel for small and for large cones",
                        0.5, sized_cone),
            sweep(long_cones_away, {4e2, 4e6}, {4e6},
                  [](double ratio) {
                      return labeled(fmt::format("{:g}-from-afar", ratio), ratio,
                                     picture_case(long_cones(ratio / 4, true)));
                  }),
            sweep({"cone-needle", "length over radius",
                   "thin cones lose their outline and their normals"},
                  {2e1, 2e2, 2e3, 2e4, 2e6}, {2e1, 2e3},
                  [](double ratio) {
                      const double radius = 2 / ratio;
                      return picture_case(cone_needle(radius), small_tolerance(radius));
                  }),
            sweep({"flat-cone", "height over radius", "all hits lie within rounding of both rims"},
                  {2e-1, 2e-2, 2e-3, 2e-4, 2e-6, 2e-8, 2e-12}, {2e-2, 2e-8},
                  [](double ratio) { return flat_cone(ratio / 2); }),
            scaled_and_moved("cylinder-scale",
                             "absolute epsilons fill small tubes and leave holes in large ones",
                             tubes()),
            scaled_and_moved("glass-scale", "absolute epsilons skip the far side of small glass",
                             glass_still_life()),
            leaving_cones("leaving-cone", 3,
                          "an absolute epsilon causes acne on large cones and holes in small ones"),
            leaving_cones("leaving-far-cone", 1000, "the same with the cone a thousand radii away"),
            outline_family("cone-rays",
                           [](double radius) { return past_cone(cone_to_aim_at(radius, 1)); })};
}

}  // namespace rt
