// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "host/stress/case_helpers.h"
#include "host/stress/families.h"
#include "host/stress/ray_trials.h"
#include "host/stress/shape_families.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

/// A frustum as long as it is wide, 1 away, half as high as the picture; or the eye inside it.
Scene sized_cone(double radius) {
    const double half_angle = radius < 1 ? 2 * std::atan(radius) : 0.5;
    Scene scene = shape_scene(degrees(2 * half_angle));
    const glm::dvec3 half = radius * glm::dvec3(0.28, 0.75, 0.6);
    add_cone(scene, -half, radius, half, 0.5 * radius, 0);
    return scene;
}

/// A tube and a cone of radius 0.25 and 0.5 that run off to the horizon, over a floor.
Scene long_cones(double length) {
    Scene scene = bare_scene();
    set_image_size(scene, 80, 60);
    const int red = add_matt(scene, {0.875, 0.25, 0.125}, 0.25, 20);
    const int mirror = add_mirror(scene, 0.5);
    for (auto& material : scene.materials) material.two_sided = true;
    const glm::dvec3 away(0.28, 0, -0.96);
    add_cone(scene, {-0.5, 0.5, 1}, 0.25, glm::dvec3(-0.5, 0.5, 1) + length * away, 0.25, red);
    add_cone(scene, {0.5, 0.5, 1}, 0.5, glm::dvec3(0.5, 0.5, 1) + length * away, 0, mirror);
    add_floor(scene, {0, -0.5, 0}, 12, red);
    set_view(scene, {0, 2, 5}, {0.5, 0.5, -2}, 50);
    return scene;
}

StressFamily long_cone_family() {
    StressFamily family{
        "long-cone", "length over radius", "the far end's numbers drown those of the near one", {}};
    for (const double length : {1e1, 1e2, 1e4, 1e6, 1e8}) {
        family.cases.push_back(picture_case(fmt::format("{:g}", 4 * length), 4 * length,
                                            quick_if(length == 1e2 || length == 1e6),
                                            [length] { return long_cones(length); }));
    }
    return family;
}

/// A needle of length 2 across a narrow view, taking up about a fifth of its height.
Scene cone_needle(double radius) {
    Scene scene = shape_scene(degrees(8 * radius));
    add_cone(scene, {-1, -0.25 * radius, -0.125}, radius, {1, 0.5 * radius, 0.25}, 0.5 * radius, 0);
    return scene;
}

StressFamily cone_needles() {
    StressFamily family{
        "cone-needle", "length over radius", "thin cones lose their outline and their normals", {}};
    for (const double radius : {1e-1, 1e-2, 1e-3, 1e-4, 1e-6}) {
        family.cases.push_back(picture_case(
            fmt::format("{:g}", 2 / radius), 2 / radius, quick_if(radius == 1e-1 || radius == 1e-3),
            [radius] { return cone_needle(radius); }, small_tolerance(radius)));
    }
    return family;
}

/// A ring of almost no height. In float the rims are distinguished by height above the base, which
/// fails where the ring is flatter than the rounding of these.
Scene flat_cone(double height) {
    Scene scene = shape_scene(60);
    const glm::dvec3 axis(0.28, 0.576, 0.768);
    add_cone(scene, {0, 0, 0}, 0.5, height * axis, 0.125, 0);
    return scene;
}

StressFamily flat_cones() {
    StressFamily family{
        "flat-cone", "height over radius", "all hits lie within rounding of both rims", {}};
    for (const double height : {1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8}) {
        StressTolerance tolerance;
        tolerance.in_float = height >= 1e-3;
        family.cases.push_back(picture_case(
            fmt::format("{:g}", 2 * height), 2 * height, quick_if(height == 1e-2 || height == 1e-4),
            [height] { return flat_cone(height); }, tolerance));
    }
    return family;
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

/// The scene scaled and moved; powers of two and whole numbers must not change a bit.
StressFamily scaled_and_moved(const char* name, const char* why, Scene (*scene)()) {
    StressFamily family{name, "scale, or distance from the origin", why, {}};
    const auto small = [scene] {
        Scene result = scene();
        set_image_size(result, 80, 60);
        return result;
    };
    const auto add = [&](std::string label, double value, InQuick quick, bool same_bits,
                         std::function<Scene()> make) {
        family.cases.push_back(picture_case(std::move(label), value, quick, std::move(make)));
        if (!same_bits) return;
        std::get<PictureTrial>(family.cases.back().trial).same_bits = "the scene as it is";
    };
    const auto scaled = [small](double factor) {
        return [=] {
            Scene result = small();
            scale_scene(result, factor);
            return result;
        };
    };
    add("as-it-is", 1, InQuick::yes, true, small);
    for (const int k : {-40, -20, 20, 40}) {
        const double factor = std::ldexp(1.0, k);
        add(fmt::format("2^{}", k), factor, quick_if(k == -40), true, scaled(factor));
    }
    for (const int k : {-30, -15, -6, -3, 3, 6, 15, 30}) {
        const double factor = std::pow(10.0, k);
        add(fmt::format("10^{}", k), factor, InQuick::no, false, scaled(factor));
    }
    for (const double by : {1e3, 1e6, 1e9}) {
        add(fmt::format("moved-{:g}", by), by, quick_if(by == 1e6), true, [=] {
            Scene result = small();
            shift_scene(result, {by, -by, by < 5e8 ? 2 * by : by});
            return result;
        });
    }
    return family;
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
        const Scene scene = cone_to_aim_at(radius, distances * radius);
        return both_precisions([=]<typename T>(std::uint64_t rays, const RayCaster& caster) {
            return count_cone_leaving_failures<T>(scene, shallowest, rays, caster);
        });
    });
}

StressFamily cone_rays() {
    return outline_family("cone-rays", [](double radius) {
        const Scene scene = cone_to_aim_at(radius, 1);
        return both_precisions([=]<typename T>(std::uint64_t rays, const RayCaster& caster) {
            return count_cone_failures<T>(scene, rays, caster);
        });
    });
}

}  // namespace

void add_cone_families(StressFamilies& families) {
    families.push_back(size_family("cone-size",
                                   "the quadratic's terms cancel for small and for large cones",
                                   0.5, sized_cone));
    for (const auto make : {long_cone_family, cone_needles, flat_cones}) {
        families.push_back(make());
    }
    families.push_back(scaled_and_moved(
        "cylinder-scale", "absolute epsilons fill small tubes and prick large ones", tubes));
    families.push_back(scaled_and_moved(
        "glass-scale", "absolute epsilons skip the far side of small glass", glass_still_life));
    families.push_back(leaving_cones(
        "leaving-cone", 3, "an absolute epsilon is acne on large cones and a hole in small ones"));
    families.push_back(
        leaving_cones("leaving-far-cone", 1000, "the same with the cone a thousand radii away"));
    families.push_back(cone_rays());
}

}  // namespace rt
