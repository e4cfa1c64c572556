// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/measure/timing.h"
#include "host/picture/render_settings.h"

namespace rt {

/// The RMSEs that "seconds to reach" are given for.
inline constexpr std::array<double, 4> rmse_targets{1e-2, 3e-3, 1e-3, 3e-4};

/// What a point of `mirrorball converge` asks for.
struct ConvergeCase {
    std::string device;       ///< spec for --device: "threads", "0"
    std::string device_name;  ///< "threads", or the OpenCL device's own name
    PictureSpec picture;
};

/// What distinguishes a point's build from others.
template <typename A, typename X>
void describe_build(A& a, X& x) {
    a("device", x.device, "as for --device");
    a("device_name", x.device_name, "\"threads\", or the OpenCL device's name");
    a("precision", x.picture.precision, "of the arithmetic");
    a("math", x.picture.math, "strict or fast");
}

/// Figures of a right point.
struct PointFigures {
    Spread seconds;            ///< picture_seconds: without open and build
    double rmse = 0;           ///< median over the repeats (equal in strict arithmetic)
    bool below_floor = false;  ///< closer to the reference than the reference's estimated error
};

template <typename A, Of<PointFigures> X>
void describe(A& a, X& x) {
    a("seconds", x.seconds, "of a picture, without open and build");
    a("rmse", x.rmse, "relative to the reference, clamped to 0..1");
    a("below_floor", x.below_floor, "whether that is below the reference's own error");
}

/// A point of the error-time plane and its runs. RenderStats::error is against the
/// converged reference, on values clamped to [0,1].
struct ConvergePoint : TimedRuns {
    ConvergeCase asked;
    std::optional<ErrorEstimate> estimate;  ///< of the picture's error, in strict arithmetic
    std::optional<PointFigures> figures;    ///< empty unless the point is right
};

template <typename A, Of<ConvergePoint> X>
void describe(A& a, X& x) {
    describe_build(a, x.asked);
    a("max_bounces", x.asked.picture.max_bounces, "mirror and refracted rays after the eye ray");
    a("aa", x.asked.picture.aa, "as for --aa");
    a("filter", x.asked.picture.filter, "reconstruction filter");
    a("seed", x.asked.picture.seed, "of sobol samples");
    a("estimate", x.estimate, "of its error, without a reference; for strict math");
    describe_runs(a, x, x.figures);
}

/// The converged picture: the mean of two independent halves, in double with strict arithmetic.
struct ConvergeReference {
    std::vector<std::string> halves;  ///< how they were sampled; none: unknown
    std::vector<std::string> hashes;  ///< of the halves' bytes as float
    int max_bounces = 0;
    double halves_rmse = 0;  ///< between the halves, clamped to [0,1]
    double seconds = 0;      ///< to render the halves
    std::string file;        ///< --reference, if it was read from there

    /// The reference's own RMSE, estimated: errors of independent halves add in quadrature, so
    /// their mean is off by half their difference. Below it, nothing can be said about a picture.
    double floor() const { return halves_rmse / 2; }
};

template <typename A, Of<ConvergeReference> X>
void describe(A& a, X& x) {
    a("file", unless_empty(x.file), "of --reference, if it was read from there");
    a("halves", x.halves, "how each half was sampled; none: unknown");
    a("hashes", x.hashes, "of the halves as float");
    a("precision", Precision::float64, "of the arithmetic");
    a("max_bounces", x.max_bounces, "mirror and refracted rays after the eye ray");
    a("halves_rmse", x.halves_rmse, "between the halves, clamped to 0..1");
    a("floor", x.floor(), "the reference's own RMSE, half of that");
    a("seconds", x.seconds, "to render the halves");
}

/// Points that differ only in sampling, in sweep order.
struct Curve {
    ConvergeCase of;     ///< its device, precision, math and bounces
    std::string family;  ///< "grid" (with none), "sobol", "adaptive", "edges"
    std::vector<std::size_t> points;
    std::optional<double> slope;  ///< of log RMSE over log seconds; none for a single point
};

template <typename A, Of<Curve> X>
void describe(A& a, X& x) {
    describe_build(a, x.of);
    a("max_bounces", x.of.picture.max_bounces, "mirror and refracted rays after the eye ray");
    a("family", x.family, "of AA modes: grid (with none), sobol, adaptive, edges");
    a("points", x.points, "indices into points");
    a("slope", or_null(x.slope), "of log RMSE over log seconds");
}

/// Extra seconds of a device's first picture.
struct BuildOffset {
    ConvergeCase of;         ///< its device, precision and math
    double open = 0;         ///< median
    double first_build = 0;  ///< of the first picture, with an empty kernel cache
    Spread warm_build;       ///< over all repeats
};

template <typename A, Of<BuildOffset> X>
void describe(A& a, X& x) {
    describe_build(a, x.of);
    a("open", x.open, "seconds to open the device, median");
    a("first_build", x.first_build, "seconds of the first picture");
    a("warm_build", x.warm_build, "seconds of later pictures");
}

/// How soon a device reaches an RMSE, with the fastest measured setting that does.
struct TargetTime {
    std::string device, device_name;
    double target = 0;
    std::optional<std::size_t> point;  ///< empty when no setting reached it
    std::optional<double> seconds;     ///< its median picture_seconds
    bool below_floor = false;          ///< the target itself is below the floor: undecidable
};

template <typename A, Of<TargetTime> X>
void describe(A& a, X& x) {
    a("device", x.device, "as for --device");
    a("device_name", x.device_name, "\"threads\", or the OpenCL device's name");
    a("rmse", x.target, "to be reached");
    a("seconds", or_null(x.seconds), "of the fastest setting that reaches it; null: none does");
    a("point", or_null(x.point), "its index in points");
    a("below_floor", x.below_floor, "whether the reference cannot tell");
}

/// All results of `mirrorball converge`.
struct ConvergeResult {
    double load_before = -1;  ///< see other_load
    SceneId scene;
    int width = 0, height = 0;  ///< pixels
    int repeats_asked = 0;
    bool interrupted = false;
    ConvergeReference reference;
    std::vector<ConvergePoint> points;  ///< by device, precision, math, bounces; then AA

    // Computed by summarize:
    std::vector<std::size_t> front;  ///< points on the Pareto front, by increasing seconds
    std::vector<Curve> curves;
    std::vector<BuildOffset> builds;
    std::vector<TargetTime> targets;  ///< devices in the order of the points; largest first

    /// Computes the figures of all points and what follows from them.
    void summarize();
};

template <typename A, Of<ConvergeResult> X>
void describe(A& a, X& x) {
    a("scene", x.scene, "");
    a("width", x.width, "pixels");
    a("height", x.height, "pixels");
    a("repeats", x.repeats_asked, "timed rounds asked for");
    a("interrupted", x.interrupted, "whether a signal ended it early");
    a("reference", x.reference, "the mean of two independent halves");
    a("points", x.points, "a device, precision, math and sampling each");
    a("pareto_front", x.front, "indices into points, by increasing seconds");
    a("curves", x.curves, "points that differ only in sampling");
    a("builds", x.builds, "extra time for the first picture");
    a("seconds_to_rmse", x.targets, "time to reach an RMSE");
}

/// Run time and error of one way to make a picture.
struct Cost {
    double seconds = 0, rmse = 0;
};

/// The Pareto front: ways for which no other is at least as fast and as accurate, and better in
/// one, to the three digits that tables show. Indices by increasing seconds, hence decreasing
/// error; of equals, the first.
std::vector<std::size_t> pareto_front(std::span<const Cost> costs);

/// The slope of log RMSE over log seconds, by least squares: -0.5 for plain random sampling. Costs
/// with a 0 are left out; empty when fewer than two different times remain.
std::optional<double> log_log_slope(std::span<const Cost> costs);

/// What to measure.
struct ConvergeOptions {
    std::string scene;
    std::optional<PictureSize> size;  ///< default: the scene's
    std::vector<AaMode> aa;
    std::vector<std::string> devices{"all"};
    int threads = 0;  ///< of the pthreads renderer; 0: all cores
    std::vector<Precision> precisions{Precision::float32, Precision::float64};
    std::vector<Math> math{Math::strict};
    std::vector<int> max_bounces;  ///< empty: the scene's
    LightOverrides light;
    int repeats = 5;               ///< not counting the warm-up
    int reference_samples = 1024;  ///< per pixel, in each half of the reference
    std::string reference;         ///< the file it is kept in; empty: none
    bool quiet = false;
};

/// Measures. Throws Error.
ConvergeResult measure_converge(const ConvergeOptions& options);

}  // namespace rt
