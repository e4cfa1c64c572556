// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/picture/render_stats.h"

// Repeated runs of one picture, and figures of them.
namespace rt {

/// Outcome of a case.
enum class Verdict {
    right,       ///< every picture agrees with the reference
    wrong,       ///< a picture does not: no timing is given
    failed,      ///< the device could not render it
    unfinished,  ///< stopped before the first repeat was done
};

inline constexpr Named<Verdict> verdict_names[] = {{"right", Verdict::right},
                                                   {"wrong", Verdict::wrong},
                                                   {"failed", Verdict::failed},
                                                   {"unfinished", Verdict::unfinished}};
constexpr auto& enum_names(Verdict) { return verdict_names; }
inline const char* to_string(Verdict verdict) { return name_of(verdict_names, verdict); }

/// A run of a benchmark. RenderStats::phases.start and .write are 0, .total is timed_total().
struct TimedRun : RenderStats {
    std::optional<double> started;  ///< seconds since the first run of the benchmark began
};

template <typename A, Of<TimedRun> X>
void describe(A& a, X& x) {
    a("started", x.started, "seconds since the first run of the benchmark began");
    describe_run(a, x);
    a("error", x.error, "of the picture, clamped to 0..1");
}

/// Every run of a case, and their outcome.
struct TimedRuns {
    std::vector<TimedRun> warm_up;  ///< the first round, kept separately; not used in any figure
    std::vector<TimedRun> repeats;  ///< one per round, in order
    Verdict verdict = Verdict::unfinished;
    std::string why;  ///< what is wrong or what failed; empty when right

    bool has_figures() const { return verdict == Verdict::right && !repeats.empty(); }
};

/// With the figures computed from the runs, null for wrong pictures.
template <typename A, typename X, typename Figures>
void describe_runs(A& a, X& x, const std::optional<Figures>& figures) {
    a("verdict", x.verdict, "whether every picture is what it should be");
    a("why", x.why, "what is wrong or what failed");
    a("figures", or_null(figures), "computed from the repeats; null for a wrong picture");
    a("warm_up", x.warm_up, "the first round; in no figure");
    a("repeats", x.repeats, "the other rounds, in order");
}

/// The middle value, or the mean of the two middle ones; 0 for none.
double median(std::vector<double> values);

/// The median distance from the median: noise, in the values' own unit; 0 for none.
double median_absolute_deviation(const std::vector<double>& values);

/// Distribution of repeated measurements.
struct Spread {
    double median = 0, mad = 0, min = 0, max = 0;

    /// MAD in percent of the median; 0 when the median is 0.
    double noise_percent() const { return median > 0 ? 100 * mad / median : 0; }
};

template <typename A, Of<Spread> X>
void describe(A& a, X& x) {
    a("median", x.median, "of the repeats");
    a("mad", x.mad, "median absolute deviation from the median");
    a("min", x.min, "");
    a("max", x.max, "");
}

Spread spread_of(const std::vector<double>& values);

/// The spread of one figure over runs.
Spread spread_of(std::span<const TimedRun> runs,
                 const std::function<double(const RenderStats&)>& figure);

/// What the benchmarks call total, in seconds: flatten, open, build, upload, trace, resolve and
/// read back. Excludes process start, loading the scene and writing the picture.
double timed_total(const RenderStats& run);

/// The same without open and build, in seconds: what one more picture costs once the device is
/// open and the kernels are built.
double picture_seconds(const RenderStats& run);

double trace_seconds(const RenderStats& run);

}  // namespace rt
