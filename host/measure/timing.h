// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sched.h>

#include <functional>
#include <istream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/image/picture.h"
#include "host/opencl/devices.h"
#include "host/picture/render_picture.h"
#include "host/picture/render_stats.h"
#include "host/record/record.h"
#include "host/scene/scene.h"
#include "host/scene/scene_file.h"

// Repeated runs of one picture, figures of them, and what disturbs them.
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

/// Seconds since some moment.
struct CoreTimes {
    double wall = 0;
    double used = 0;  ///< of the cores available, by all programs; below 0: unknown
    double own = 0;   ///< by this process
};

/// What all programs have used of these cores, by /proc/stat: "cpu0 user nice system idle iowait
/// irq softirq steal ..." in ticks. Below 0 if one is missing.
double used_seconds(std::istream& stat, const cpu_set_t& which);

/// The average that other programs kept busy.
double load_between(const CoreTimes& from, const CoreTimes& to);

/// How many of the cores that are available to this process others keep busy, on average: by the
/// first call, over a fifth of a second, in which this process should do nothing; by later ones,
/// that or the one since, whichever is more. Below 0: unknown.
double other_load();

/// One line if this load disturbs timings, for at least a quarter of each core is in use; else "".
std::string busy_text(double load);

/// {"load_before", "load_per_core", "busy"}; null where unknown.
Json machine_load_json(double load);

/// A scene as loaded; options override.
struct TimedScene {
    SceneId id;
    Scene scene;
    double load_seconds = 0;  ///< noted in every run
};

/// Loads a scene file, the built-in scene for "", and prints its notes unless `quiet`.
TimedScene load_timed_scene(const std::string& path, const LightOverrides& light, bool quiet);

/// One way to render one picture, to be timed, and the runs once it is.
struct TimedCase : TimedRuns {
    const TimedScene* scene = nullptr;
    const Picture* reference = nullptr;  ///< of the same size; errors are relative to it
    DeviceChoice device;
    RenderSettings settings;
    std::optional<RenderStats> right;  ///< those of threads, in strict arithmetic
};

/// The devices that specs name, without duplicates; "all" means threads and every usable OpenCL
/// device, with a line on stderr for each unusable one. Throws Error (usage or device) like
/// choose_device. OpenCL is not loaded if only threads are named.
std::vector<DeviceChoice> listed_devices(const std::vector<std::string>& specs);

/// The settings for a benchmark's renders, which fail if their device fails and are judged by the
/// benchmark itself.
RenderSettings timed_settings(RenderSettings settings = {});

/// Renders on the device silently, until a stop signal; the cache may be null.
RenderedPicture render_quietly(const Scene& scene, const RenderSettings& settings,
                               const DeviceChoice& device, RenderCache* cache = nullptr);

/// Renders every case once to warm up, then again `repeats` times; the rounds go over all cases (A
/// B A B), so that a slow moment of the machine hits all alike. Every picture is judged; a case
/// that is wrong or fails is not run again. A signal ends it after the pictures finished so far.
/// Prints a line on stderr for each round unless `quiet`. Returns whether it ran to the end.
bool run_rounds(std::vector<TimedCase>& cases, int repeats, bool quiet);

/// Warns on stderr, unless `quiet`, that the machine is busy with other work.
void say_busy(bool quiet);

}  // namespace rt
