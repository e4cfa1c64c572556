// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/measure/timing.h"
#include "host/picture/render_settings.h"

namespace rt {

/// What a row of `mirrorball bench` asks for.
struct BenchCase {
    SceneId scene;
    PictureSpec picture;
    std::string device;       ///< spec for --device: "threads:2", "0"
    std::string device_name;  ///< "threads", or the OpenCL device's own name
    int threads = 0;          ///< asked for; 0 for OpenCL
    std::string schedule;     ///< "tiles", "buffers" or "scalar" (tiles, one ray at a time); empty
                              ///< for OpenCL

    bool uses_threads() const { return !schedule.empty(); }
};

/// Identifies a row across results: scene hash, size, AA, precision, device, schedule.
std::string key_of(const BenchCase& asked);

/// Figures of a right row, each computed from medians over its repeats.
struct BenchFigures {
    Spread trace, total;         ///< seconds
    double rays_per_second = 0;  ///< rays over the median trace seconds
    int threads = 0;             ///< that ran; 0 for OpenCL
    /// Total seconds of one thread over this row's: the same scene and picture, in the same
    /// schedule (for OpenCL: tiles, else buffers). Empty when one thread was not measured.
    std::optional<double> speed_up;
    std::optional<double> trace_speed_up;     ///< the same of trace seconds
    std::optional<double> parallel_fraction;  ///< of that one-thread row; empty for OpenCL
    std::optional<double> amdahl;             ///< the speed-up it predicts for these threads
    std::optional<double> over_amdahl;        ///< speed_up - amdahl
};

template <typename A, Of<BenchFigures> X>
void describe(A& a, X& x) {
    a("trace", x.trace, "seconds to trace");
    a("total", x.total, "seconds from flatten to read back");
    a("rays_per_second", x.rays_per_second, "by the median trace seconds");
    a("threads", x.threads, "that ran; 0 for OpenCL");
    a("speed_up", or_null(x.speed_up), "of total, relative to one thread");
    a("trace_speed_up", or_null(x.trace_speed_up), "of trace, relative to one thread");
    a("parallel_fraction", or_null(x.parallel_fraction), "trace over total of one thread");
    a("amdahl", or_null(x.amdahl), "the speed-up that Amdahl's law predicts");
    a("over_amdahl", or_null(x.over_amdahl), "speed_up - amdahl");
}

/// A row: one case and its runs. RenderStats::error is against the double reference, on values
/// clamped to [0,1].
struct BenchRow : TimedRuns {
    BenchCase asked;
    std::optional<BenchFigures> figures;  ///< empty unless the row is right
};

template <typename A, Of<BenchRow> X>
void describe(A& a, X& x) {
    a("key", key_of(x.asked), "identifies the row across results");
    a("scene", x.asked.scene, "");
    describe(a, x.asked.picture);
    a("device", x.asked.device, "as for --device");
    a("device_name", x.asked.device_name, "\"threads\", or the OpenCL device's name");
    a("threads", x.asked.threads, "asked for; 0 for OpenCL");
    a("schedule", x.asked.schedule, "tiles, buffers or scalar; empty for OpenCL");
    describe_runs(a, x, x.figures);
}

/// A picture in double, strict, on threads, and its run.
struct ReferenceRun : TimedRun {};

template <typename A, Of<ReferenceRun> X>
void describe(A& a, X& x) {
    const SceneId& scene = x.scene;
    const TimedRun& run = x;
    a("scene", scene, "");
    describe(a, run);
}

/// All results of `mirrorball bench`.
struct BenchResult {
    double load_before = -1;  ///< see other_load
    int repeats_asked = 0;
    bool interrupted = false;
    std::vector<ReferenceRun> references;  ///< one per scene, size, AA mode
    std::vector<BenchRow> rows;            ///< by scene, size, AA, precision; then devices

    /// Computes the figures of all rows.
    void judge();
};

template <typename A, Of<BenchResult> X>
void describe(A& a, X& x) {
    a("repeats", x.repeats_asked, "timed rounds asked for");
    a("interrupted", x.interrupted, "whether a signal ended it early");
    a("references", x.references, "double, strict, on threads; one per scene, size and AA mode");
    a("rows", x.rows, "a device, precision and picture each");
}

/// The share of a one-thread run that more threads can shorten, as the paper measures it (section
/// 5.3): ray trace seconds over total seconds. 0 when nothing was measured.
double parallel_fraction(double trace_seconds, double total_seconds);

/// Amdahl's law: how many times faster `threads` threads can be at most, 1 / ((1 - f) + f / n).
double amdahl_speed_up(double parallel_fraction, int threads);

/// How threads render a row's picture.
struct ThreadsWay {
    Schedule schedule = Schedule::tiles;
    bool is_scalar = false;  ///< without vectors: one ray at a time

    bool operator==(const ThreadsWay&) const = default;
};

inline constexpr Named<ThreadsWay> threads_ways[] = {{"tiles", {Schedule::tiles, false}},
                                                     {"buffers", {Schedule::buffers, false}},
                                                     {"scalar", {Schedule::tiles, true}}};

/// What to measure.
struct BenchOptions {
    std::vector<std::string> scenes;  ///< empty: the built-in scene
    std::vector<PictureSize> sizes{{100, 100}, {200, 200}, {300, 300}, {400, 400}, {500, 500}};
    std::vector<AaMode> aa;
    std::vector<std::string> devices{"all"};
    int threads = 0;  ///< "threads" runs with 1 to this many; 0: all cores
    std::vector<Precision> precisions{Precision::float32, Precision::float64};
    std::vector<ThreadsWay> ways;  ///< of threads
    LightOverrides light;
    int repeats = 5;  ///< not counting the warm-up
    bool quiet = false;
};

BenchResult measure_bench(const BenchOptions& options);

}  // namespace rt
