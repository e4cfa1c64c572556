// SPDX-License-Identifier: Apache-2.0
#include "host/measure/converge.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/image/output_path.h"
#include "host/measure/machine_load.h"
#include "host/print/print_converge.h"
#include "host/print/print_run.h"
#include "host/print/print_stats.h"
#include "host/print/result_file.h"
#include "host/process/stop_signal.h"
#include "host/render/stopwatch.h"
#include "host/scene/scene_file.h"
#include "host/scene/scene_hash.h"
#include "host/verbs/converge_reference.h"
#include "host/verbs/device_list.h"
#include "host/verbs/measure.h"
#include "host/verbs/timing_loop.h"
#include "host/verbs/verbs.h"

namespace rt {

namespace {

/// The devices named, plus scalar threads if requested.
std::vector<ListedDevice> swept_devices(const ConvergeOptions& options) {
    std::vector<ListedDevice> devices = listed_devices(options.devices);
    for (std::size_t i = options.scalar ? devices.size() : 0; i-- > 0;) {
        if (!devices[i].is_threads) continue;
        ListedDevice scalar = devices[i];
        scalar.spec += " scalar";
        scalar.is_scalar = true;
        devices.insert(devices.begin() + static_cast<std::ptrdiff_t>(i) + 1, std::move(scalar));
    }
    return devices;
}

/// The points of one device at one precision and math, in the order of the sweep.
void add_points(const ConvergeOptions& options, const std::vector<int>& bounces,
                const ListedDevice& device, const ConvergeCase& of,
                std::vector<ConvergePoint>& points) {
    for (const int max_bounces : bounces) {
        for (const AaMode& aa : options.aa) {
            ConvergePoint point;
            point.asked = of;
            point.asked.device = device.spec;
            point.asked.device_name = device.name;
            point.asked.max_bounces = max_bounces;
            point.asked.aa = aa;
            points.push_back(std::move(point));
        }
    }
}

/// Omits double on devices without it and on scalar threads, which only show what vectors gain, and
/// fast math on threads: it is an OpenCL compiler option.
std::vector<ConvergePoint> planned_points(const ConvergeOptions& options,
                                          const std::vector<int>& bounces,
                                          const std::vector<ListedDevice>& devices) {
    std::vector<ConvergePoint> points;
    for (const ListedDevice& device : devices) {
        for (const Precision precision : options.precisions) {
            for (const bool fast_math : options.fast_math) {
                ConvergeCase of;
                of.double_precision = precision == Precision::float64;
                of.fast_math = fast_math;
                if (of.double_precision && (!device.has_double || device.is_scalar)) continue;
                if (fast_math && device.is_threads) continue;
                add_points(options, bounces, device, of, points);
            }
        }
    }
    return points;
}

TimedCase timed_case(const ConvergeCase& asked, const ConvergeOptions& options,
                     const std::vector<ListedDevice>& devices) {
    TimedCase timed;
    timed.path = options.scene;
    const ListedDevice& device =
        *std::find_if(devices.begin(), devices.end(),
                      [&](const ListedDevice& one) { return one.spec == asked.device; });
    timed.device = device.choice;
    timed.settings = timed_settings();
    if (device.is_scalar) timed.settings.lanes = 1;
    timed.settings.aa = asked.aa;
    timed.settings.max_bounces = asked.max_bounces;
    timed.settings.precision = asked.double_precision ? Precision::float64 : Precision::float32;
    timed.settings.fast_math = asked.fast_math;
    if (device.is_threads && device.threads == 0) timed.settings.threads = options.threads;
    timed.judge = judge_estimate;
    return timed;
}

/// Hashes of a scene's pictures as threads compute them: every device must give these bits.
class ThreadsHashes {
   public:
    explicit ThreadsHashes(const Scene& scene) : scene_(scene) {}

    /// Empty if the render was stopped.
    std::optional<std::uint64_t> of(RenderSettings settings) {
        const auto [place, is_new] = hashes_.try_emplace(
            Key{settings.precision, settings.max_bounces, to_string(*settings.aa)});
        if (is_new) {
            settings.lanes = 0;
            Scene scene = scene_;
            apply_overrides(scene, settings);
            const RenderStats stats = render_quietly(scene, settings, threads_choice()).stats;
            if (stats.complete()) place->second = stats.image_hash;
        }
        return place->second;
    }

   private:
    using Key = std::tuple<Precision, std::optional<int>, std::string>;
    const Scene& scene_;
    std::map<Key, std::optional<std::uint64_t>> hashes_;
};

/// Times the points of the result against the converged picture.
void time_points(const Scene& scene, double load_seconds, const ConvergedPicture& converged,
                 const ConvergeOptions& options, const std::vector<ListedDevice>& devices,
                 ConvergeResult& result) {
    std::vector<TimedCase> cases;
    ThreadsHashes hashes(scene);
    for (const ConvergePoint& point : result.points) {
        TimedCase timed = timed_case(point.asked, options, devices);
        timed.scene = &scene;
        timed.reference = &converged.picture;
        timed.load_seconds = load_seconds;
        if (!point.asked.fast_math) timed.expected_hash = hashes.of(timed.settings);
        cases.push_back(std::move(timed));
    }
    result.interrupted = !run_rounds(cases, options.repeats, options.quiet);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        static_cast<TimedRuns&>(result.points[i]) = std::move(cases[i]);
    }
}

/// Reports the points without a result. Returns the exit status.
int verdict(const ConvergeResult& result) {
    bool wrong = false, failed = false;
    for (const ConvergePoint& point : result.points) {
        if (point.verdict != Verdict::wrong && point.verdict != Verdict::failed) continue;
        (point.verdict == Verdict::wrong ? wrong : failed) = true;
        print_note(fmt::format("{} {}: {}: {}", point.asked.device_name, to_string(point.asked.aa),
                               to_string(point.verdict), point.why));
    }
    if (result.interrupted) return 128 + stop_flag();
    if (wrong) return static_cast<int>(ExitCode::different);
    return static_cast<int>(failed ? ExitCode::device : ExitCode::done);
}

}  // namespace

ConvergeResult measure_converge(const ConvergeOptions& options) {
    ConvergeResult result;
    result.repeats_asked = options.repeats;
    say_busy(options.quiet);
    const Stopwatch watch;
    Scene scene = load_scene(options.scene, options.light);
    const double load_seconds = watch.seconds();
    if (options.size) set_image_size(scene, options.size->width, options.size->height);
    result.scene_path = options.scene;
    result.scene_name = scene.name;
    result.notes = scene.notes;
    result.scene_hash = scene_hash(scene);
    result.width = scene.width;
    result.height = scene.height;
    std::vector<int> bounces = options.max_bounces;
    if (bounces.empty()) bounces.push_back(scene.max_bounces);
    const std::vector<ListedDevice> devices = swept_devices(options);
    result.points = planned_points(options, bounces, devices);
    if (result.points.empty()) {
        throw Error(
            ExitCode::usage,
            "nothing to measure: no device supports this combination of --precision and --math");
    }
    bounces.push_back(scene.max_bounces);
    scene.max_bounces = *std::max_element(bounces.begin(), bounces.end());
    const ConvergedPicture converged = converged_picture(scene, options);
    result.reference = converged.about;
    result.interrupted = !converged.complete;
    if (converged.complete) {
        time_points(scene, load_seconds, converged, options, devices, result);
    }
    result.load_before = other_load();
    return result;
}

int run_converge(const ConvergeOptions& options) {
    check_result_path(options.results.json, json_start("mirrorball-converge"));
    check_result_path(options.results.csv, run_csv_header());
    check_outputs_differ({options.results.json, options.results.csv});
    const FreshKernelCache kernels;
    const ConvergeResult result = measure_converge(options);
    if (!options.quiet) print_notes(result.notes);
    if (!options.results.take_stdout()) print_result(converge_text(result));
    write_result(options.results.json, json_text(converge_json(result)));
    write_result(options.results.csv, converge_csv(result));
    return verdict(result);
}

}  // namespace rt
