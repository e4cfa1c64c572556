// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "host/flatten/flat_scene.h"
#include "host/record/describe.h"
#include "host/render/picture_spec.h"
#include "host/render/renderer.h"
#include "host/scene/scene.h"

namespace rt {

/// Makes tracers for the suite's ray trials: on threads, or on an OpenCL device.
struct RayCaster {
    std::function<RayTracer<float>(const FlatScene<float>&)> in_float;
    std::function<RayTracer<double>(const FlatScene<double>&)> in_double;

    template <typename T>
    RayTracer<T> tracer(const FlatScene<T>& scene) const {
        if constexpr (std::is_same_v<T, float>) {
            return in_float(scene);
        } else {
            return in_double(scene);
        }
    }
};

/// Native kernels on all cores, in packets of `lanes` rays (0: the vector width).
RayCaster threads_ray_caster(int lanes = 0);

inline constexpr double usual_error = 1e-4;

/// The errors allowed in a picture. A pixel is wrong when a channel, clamped to [0, 1], is off by
/// more than 1/255 or is NaN; it lies at an edge when the reference itself changes there by more
/// than 0.5/255 as the sample moves by 0.02 pixel.
struct StressTolerance {
    std::size_t most_wrong = 0;  ///< pixels, away from edges
    std::size_t most_wrong_at_edges = std::numeric_limits<std::size_t>::max();
    double max_error = usual_error;  ///< away from edges
    bool may_overflow = false;       ///< infinities count as saturated; NaN never does
    bool in_float = true;            ///< false: float is measured but not judged
};

template <typename A, Of<StressTolerance> X>
void describe(A& a, X& x) {
    const auto limit = [](std::size_t most) {
        return or_null(most == std::numeric_limits<std::size_t>::max() ? std::nullopt
                                                                       : std::optional(most));
    };
    a("wrong", limit(x.most_wrong), "pixels or rays allowed to be wrong, away from edges");
    a("wrong_at_edges", limit(x.most_wrong_at_edges), "and at edges; null: any number");
    a("max_error", x.max_error, "allowed away from edges");
    a("may_overflow", x.may_overflow, "infinities count as saturated");
    a("in_float", x.in_float, "false: float is measured but not judged");
}

/// The arithmetic of the reference.
enum class ReferenceKind {
    quad,      ///< 113 bits, for few rays per pixel
    extended,  ///< 64 bits, for hundreds of mirror rays a pixel: 40 times faster, and flat mirrors
               ///< lose no more than a bit a bounce
    none,      ///< no reference: only finite pixels and equal bits are required
};

/// A scene to be rendered and compared.
struct PictureTrial {
    std::function<Scene()> scene;
    /// The reference's scene if it is a different one that looks the same.
    std::optional<Scene> reference_scene;
    ReferenceKind reference = ReferenceKind::quad;
    bool same_bits = false;  ///< agrees in every bit with the family's first such trial
};

/// Totals over many rays.
struct RayFigures {
    std::uint64_t rays = 0;
    std::uint64_t failures = 0;  ///< leaks, false hits, missed hits: whatever the family counts
    double max_error = 0;        ///< relative error of a distance, where the trial measures it
};

template <typename A, Of<RayFigures> X>
void describe(A& a, X& x) {
    a("traced", x.rays, "");
    a("failures", x.failures, "leaks, false hits, missed hits: whatever the family counts");
    a("max_error", finite_or_null(x.max_error), "relative error of a distance");
}

/// Rays without a picture. The tolerance's most_wrong counts failures.
struct RayTrial {
    std::function<RayFigures(std::uint64_t rays, const RayCaster&, Precision)> run;
    std::uint64_t rays = 10'000'000, quick_rays = 100'000;
};

struct StressCase {
    std::string label;  ///< names the parameter's value: "2^-40"
    double value = 0;   ///< for plots
    StressTolerance tolerance;
    std::variant<PictureTrial, RayTrial> trial;
    bool quick = false;  ///< part of --quick
};

/// Cases that vary one parameter.
struct StressFamily {
    std::string name;       ///< for --case: lowercase letters, digits, hyphens
    std::string parameter;  ///< what the cases differ in
    std::string why;        ///< one line: what goes wrong here in naive renderers
    std::vector<StressCase> cases = {};
};

/// Every family, in the order of the tables.
std::vector<StressFamily> all_stress_families();

/// Whether a glob (*, ?, [...]) matches a case: its family's name, or "family/label".
bool fits_glob(const std::string& glob, const std::string& family, const std::string& label);

/// The cases that match any of the globs (no globs: all) and none of the unwanted, without empty
/// families. Throws Error (ExitCode::usage), listing the families, for a glob without a match.
std::vector<StressFamily> chosen_families(std::vector<StressFamily> families,
                                          const std::vector<std::string>& globs,
                                          const std::vector<std::string>& unwanted,
                                          bool quick_only);

}  // namespace rt
