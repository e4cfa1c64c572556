// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cmath>

#include "host/stress/case_helpers.h"

// Families that spheres and cones share.
namespace rt {

using SceneOfRadius = std::function<Scene(double radius)>;
using TrialOfRadius = std::function<RayTrial(double radius)>;

/// Rounding coordinates to float alone moves a small object by 2^-24 of its distance, which is 1.
/// Float is not judged where that is too much; double must be right there.
inline StressTolerance small_tolerance(double size) {
    StressTolerance tolerance;
    tolerance.in_float = size >= 1e-4;
    if (tolerance.in_float && size < 1) tolerance.max_error = 1e-4 + 16 * 0x1p-24 / size;
    return tolerance;
}

/// Pictures of a shape at distance 1: radii from 1e-6 to 1e6, with `middle` in place of 1.
inline StressFamily size_family(const char* name, const char* why, double middle,
                                const SceneOfRadius& scene) {
    StressFamily family{name, "radius over distance", why, {}};
    for (int k = -6; k <= 6; ++k) {
        const double radius = k == 0 ? middle : std::pow(10.0, k);
        family.cases.push_back(picture_case(
            fmt::format("{:g}", radius), radius, quick_if(k == -4 || k == 0 || k == 4),
            [=] { return scene(radius); }, small_tolerance(radius)));
    }
    return family;
}

/// Rays that leave a shape: radii from 1e-6 to 1e6.
inline StressFamily leaving_family(const char* name, const char* why, double max_error,
                                   const TrialOfRadius& trial_of) {
    StressFamily family{name, "radius", why, {}};
    StressTolerance tolerance;
    tolerance.max_error = max_error;
    for (int k = -6; k <= 6; ++k) {
        const double radius = std::pow(10.0, k);
        RayTrial trial = trial_of(radius);
        trial.rays = 1'000'000;
        trial.quick_rays = 50'000;
        family.cases.push_back(ray_case(fmt::format("{:g}", radius), radius, quick_if(k % 3 == 0),
                                        std::move(trial), tolerance));
    }
    return family;
}

/// Rays at a shape 1 away and past its outline and rims: radii from 1e-6 to 0.5. Down to 1e-3
/// nearly all hits and misses must match exact arithmetic; for smaller shapes, rounding the ray's
/// direction alone moves it by a fraction of the radius, and rays at the outline flip.
inline StressFamily outline_family(const char* name, const TrialOfRadius& trial_of) {
    StressFamily family{name,
                        "radius over distance",
                        "the discriminant cancels: hits become misses, distances noise",
                        {}};
    for (int k = -6; k <= 0; ++k) {
        const double radius = k == 0 ? 0.5 : std::pow(10.0, k);
        RayTrial trial = trial_of(radius);
        trial.rays = trial.quick_rays = 100'000;
        StressTolerance tolerance;
        tolerance.most_wrong = k >= -3 ? 4 : (k == -4 ? 50 : (k == -5 ? 400 : 4000));
        tolerance.max_error = 1e-4;
        family.cases.push_back(ray_case(fmt::format("{:g}", radius), radius, InQuick::yes,
                                        std::move(trial), tolerance));
    }
    return family;
}

}  // namespace rt
