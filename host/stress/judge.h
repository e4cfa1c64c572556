// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/base/hash.h"
#include "host/image/picture.h"
#include "host/render/picture_spec.h"
#include "host/stress/reference.h"
#include "host/stress/stress_case.h"

namespace rt {

/// Errors of a picture against its reference, both clamped to [0, 1].
struct PictureFigures {
    std::size_t wrong = 0;                 ///< pixels off by over 1/255 or NaN, away from edges
    std::size_t wrong_at_edges = 0;        ///< ... and at edges
    double max_error = 0;                  ///< away from edges
    std::size_t nans = 0, infinities = 0;  ///< pixels with one
    std::uint64_t hash = 0;                ///< over every bit; 0: not known
};

template <typename A, Of<PictureFigures> X>
void describe(A& a, X& x) {
    a("wrong", x.wrong, "pixels off by over 1/255, or NaN, away from edges");
    a("wrong_at_edges", x.wrong_at_edges, "and at edges");
    a("max_error", finite_or_null(x.max_error), "away from edges");
    a("nan", x.nans, "pixels with a NaN");
    a("infinite", x.infinities, "pixels with an infinity");
    a("hash", hash_text(x.hash), "of every bit");
}

/// Edges are looked up, on all cores, only for pixels off by more than 2e-5; all others count as
/// away from edges.
PictureFigures judge_stress_picture(const Picture& picture, ReferencePicture& reference);

/// The same for a picture without a reference: counts NaN and infinities only.
PictureFigures count_non_numbers(const Picture& picture);

/// What exceeds the tolerance, in words; empty if nothing does.
std::string exceeded_tolerance(const PictureFigures& figures, const StressTolerance& tolerance);
std::string exceeded_tolerance(const RayFigures& rays, const StressTolerance& tolerance);

/// One case on one renderer.
struct StressRow {
    std::string renderer;  ///< "threads" or an OpenCL device's name
    std::string device;    ///< for --device
    Precision precision = Precision::float32;
    bool judged = true;      ///< whether the tolerance applies to it
    PictureFigures figures;  ///< of the picture
    std::optional<RayFigures> rays;
    double seconds = 0;  ///< of tracing (a picture's `seconds.trace`), or of the whole trial
    std::string why;     ///< what failed; empty if nothing did

    bool passed() const { return !judged || why.empty(); }
    const char* verdict() const { return !judged ? "not judged" : why.empty() ? "pass" : "fail"; }
};

template <typename A, Of<StressRow> X>
void describe(A& a, X& x) {
    a("renderer", x.renderer, "\"threads\", or the OpenCL device's name");
    a("device", x.device, "as for --device");
    a("precision", x.precision, "of the arithmetic");
    a("verdict", std::string(x.verdict()), "pass, fail or not judged");
    a("why", x.why, "what failed");
    a("seconds", x.seconds, "to trace the picture, or of the whole trial");
    a("rays", x.rays, "of a trial without a picture");
    a("picture", x.rays ? std::nullopt : std::optional(x.figures), "of a trial with one");
}

struct StressCaseResult {
    std::string label;
    double value = 0;
    StressTolerance tolerance;
    std::vector<StressRow> rows;
    std::string disagreement;  ///< between devices that should give the same bits; empty: none
    double reference_seconds = 0;

    bool passed() const;
};

template <typename A, Of<StressCaseResult> X>
void describe(A& a, X& x) {
    a("label", x.label, "names the case within its family");
    a("value", x.value, "of the family's parameter");
    a("passed", x.passed(), "");
    a("bar", x.tolerance, "what is allowed");
    a("disagreement", x.disagreement, "between devices that should give the same bits");
    a("reference_seconds", x.reference_seconds, "to make the reference");
    a("rows", x.rows, "a renderer and precision each");
}

struct StressFamilyResult {
    std::string name, parameter, why;
    std::vector<StressCaseResult> cases;

    bool passed() const;
};

template <typename A, Of<StressFamilyResult> X>
void describe(A& a, X& x) {
    a("name", x.name, "");
    a("parameter", x.parameter, "what varies from case to case");
    a("why", x.why, "why it matters");
    a("passed", x.passed(), "");
    a("cases", x.cases, "");
}

struct StressResult {
    double load_before = 0;
    double seconds = 0;
    bool quick = false, interrupted = false;
    std::size_t unfinished = 0;  ///< families that an interruption left without a verdict
    std::vector<StressFamilyResult> families;

    bool passed() const;
};

template <typename A, Of<StressResult> X>
void describe(A& a, X& x) {
    a("quick", x.quick, "whether only quick cases ran");
    a("interrupted", x.interrupted, "whether a signal ended it early");
    a("passed", x.passed(), "");
    a("seconds", x.seconds, "in all");
    a("families", x.families, "");
}

struct RenderCache;

/// What to run.
struct StressOptions {
    std::vector<std::string> cases;   ///< globs; empty: all
    std::vector<std::string> except;  ///< globs
    std::vector<std::string> devices{"all"};
    bool quick = false;         ///< the cases and ray counts that take under a minute
    bool all_features = false;  ///< one build of the kernels for all cases; quick implies it
    std::string output;         ///< folder for pictures; empty: none
    bool quiet = false;
};

/// Runs the families' cases on the devices that the options name, threads and OpenCL, in float and
/// in double; the cache keeps what is built for the next call. Stops early, with `interrupted` on,
/// at a stop signal. Throws Error: usage or device for the devices, output for pictures.
StressResult run_stress_cases(const std::vector<StressFamily>& families,
                              const StressOptions& options, RenderCache& cache);

}  // namespace rt
