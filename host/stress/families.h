// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "host/stress/stress_case.h"

// The families of cases, and what their files share.
namespace rt {

// Cases, which get their names from a family.

/// A picture of the scene, compared with its reference.
inline StressCase picture_case(Scene scene, StressTolerance tolerance = {},
                               ReferenceKind reference = ReferenceKind::quad) {
    const auto keep = [scene = std::move(scene)] { return scene; };
    return {"", 0, tolerance, PictureTrial{keep, {}, reference}};
}

/// The same with another scene's reference, since that scene looks the same.
inline StressCase seen_as(Scene reference_scene, StressCase one) {
    std::get<PictureTrial>(one.trial).reference_scene = std::move(reference_scene);
    return one;
}

/// A picture that must agree in every bit with the family's first such one.
inline StressCase same_bits(const Scene& scene) {
    StressCase one = picture_case(scene);
    std::get<PictureTrial>(one.trial).same_bits = true;
    return one;
}

inline StressCase ray_case(RayTrial trial, StressTolerance tolerance = {}) {
    return {"", 0, tolerance, std::move(trial)};
}

/// The case with a label and a value of its own, which a sweep keeps.
inline StressCase labeled(std::string label, double value, StressCase one) {
    one.label = std::move(label);
    one.value = value;
    return one;
}

// Families.

inline std::string label_of(int value) { return std::to_string(value); }
inline std::string label_of(double value) { return fmt::format("{:g}", value); }

/// Adds a case for each value, labeled with it: make(value), which is a case, or a scene to be
/// pictured. Those of the `quick` values are part of --quick.
template <typename Value, typename Make>
StressFamily sweep(StressFamily family, const std::vector<Value>& values,
                   const std::vector<Value>& quick, const Make& make) {
    for (const Value& value : values) {
        StressCase one;
        if constexpr (std::is_same_v<std::invoke_result_t<Make, Value>, Scene>) {
            one = picture_case(make(value));
        } else {
            one = make(value);
        }
        if constexpr (std::is_arithmetic_v<Value>) {
            if (one.label.empty()) one = labeled(label_of(value), value, std::move(one));
        }
        one.quick = std::find(quick.begin(), quick.end(), value) != quick.end();
        family.cases.push_back(std::move(one));
    }
    return family;
}

template <typename Value, typename Make>
StressFamily sweep(StressFamily family, std::initializer_list<Value> values,
                   const std::vector<Value>& quick, const Make& make) {
    return sweep(std::move(family), std::vector(values), quick, make);
}

/// The case as part of --quick.
inline StressCase quick(StressCase one) {
    one.quick = true;
    return one;
}

using LabeledCase = std::pair<std::string, StressCase>;

/// Adds the cases, numbered from 0.
inline StressFamily listed(StressFamily family, const std::vector<LabeledCase>& cases) {
    for (const auto& [label, one] : cases) {
        family.cases.push_back(labeled(label, family.cases.size(), one));
    }
    return family;
}

using StressFamilies = std::vector<StressFamily>;

// In the order of the tables.
StressFamilies ordinary_families();
StressFamilies shape_families();
StressFamilies glass_families();
StressFamilies light_families();
StressFamilies eye_families();
StressFamilies triangle_families();
StressFamilies mesh_families();
StressFamilies ray_families();

// Trials that send rays through a renderer; the same rays each time.

enum class RayAim { edges, vertices };

/// Rays from near the center of a closed, star-shaped mesh to points on its edges or to its
/// vertices. A failure is a ray that hits nothing.
RayTrial leaks(const Scene& mesh, RayAim aim);

enum class MeshSide { inside, outside };

/// Rays to points within 64 u of the edges and vertices of a closed, convex mesh, from steep down
/// to a slope of 1e-6 against one of the faces there, and secondary rays from there. From inside,
/// they must meet the mesh; from outside, they must not.
RayTrial edge_escapes(const Scene& mesh, MeshSide side);

/// Rays from the eye to the scene's first sphere, and secondary rays from there: outwards, from
/// steep down to 1e-6 rad above the surface, which must not hit it again; inwards, down to
/// `shallowest` rad, which must find its far side within 0.1 %.
RayTrial leaving_sphere(const Scene& scene, double shallowest);

/// Rays from the eye past the scene's first sphere, within 1.5 times its apparent radius. A failure
/// is a ray whose hit or miss differs from quad arithmetic on the same rounded numbers; the error
/// is that of the distance.
RayTrial past_sphere(const Scene& scene);

/// As leaving_sphere, from the scene's first cone. Inwards, rays that return within a
/// thousandth of the length of a rim do not count; the others must miss, or find the far side
/// within 1 %, as exact arithmetic does.
RayTrial leaving_cone(const Scene& scene, double shallowest);

/// As past_sphere, past the scene's first cone and its rims.
RayTrial past_cone(const Scene& scene);

using TrialOfRadius = std::function<RayTrial(double radius)>;

/// Rays that leave a shape: radii from 1e-6 to 1e6.
inline StressFamily leaving_family(const char* name, const char* why, double max_error,
                                   const TrialOfRadius& trial_of) {
    return sweep({name, "radius", why},
                 {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6},
                 {1e-6, 1e-3, 1e0, 1e3, 1e6}, [=](double radius) {
                     RayTrial trial = trial_of(radius);
                     trial.rays = 1'000'000;
                     trial.quick_rays = 50'000;
                     return ray_case(trial, {.max_error = max_error});
                 });
}

/// Rays at a shape 1 away and past its outline and rims: radii from 1e-6 to 0.5. Down to 1e-3
/// nearly all hits and misses must match exact arithmetic; for smaller shapes, rounding the ray's
/// direction alone moves it by a fraction of the radius, and rays at the outline flip.
inline StressFamily outline_family(const char* name, const TrialOfRadius& trial_of) {
    const std::vector<double> radii{1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 0.5};
    return sweep({name, "radius over distance",
                  "the discriminant cancels: hits become misses, distances noise"},
                 radii, radii, [=](double radius) {
                     RayTrial trial = trial_of(radius);
                     trial.rays = trial.quick_rays = 100'000;
                     const std::size_t most_wrong =
                         radius >= 1e-3 ? 4 : (radius == 1e-4 ? 50 : (radius == 1e-5 ? 400 : 4000));
                     return ray_case(trial, {.most_wrong = most_wrong});
                 });
}

}  // namespace rt
