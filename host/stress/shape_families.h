// SPDX-License-Identifier: Apache-2.0
#pragma once

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
    return sweep({name, "radius over distance", why},
                 {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, middle, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6},
                 {1e-4, middle, 1e4}, [=](double radius) {
                     return picture_case([=] { return scene(radius); }, small_tolerance(radius));
                 });
}

/// Rays that leave a shape: radii from 1e-6 to 1e6.
inline StressFamily leaving_family(const char* name, const char* why, double max_error,
                                   const TrialOfRadius& trial_of) {
    StressTolerance tolerance;
    tolerance.max_error = max_error;
    return sweep({name, "radius", why},
                 {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6},
                 {1e-6, 1e-3, 1e0, 1e3, 1e6}, [=](double radius) {
                     RayTrial trial = trial_of(radius);
                     trial.rays = 1'000'000;
                     trial.quick_rays = 50'000;
                     return ray_case(trial, tolerance);
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
                     StressTolerance tolerance;
                     tolerance.most_wrong =
                         radius >= 1e-3 ? 4 : (radius == 1e-4 ? 50 : (radius == 1e-5 ? 400 : 4000));
                     return ray_case(trial, tolerance);
                 });
}

}  // namespace rt
