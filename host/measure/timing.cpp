// SPDX-License-Identifier: Apache-2.0
#include "host/measure/timing.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/parallel.h"
#include "host/base/text.h"
#include "host/image/image_error.h"
#include "host/opencl/pocl.h"
#include "host/process/drivers.h"
#include "host/process/stop_signal.h"
#include "host/process/worker.h"

namespace rt {

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

double median_absolute_deviation(const std::vector<double>& values) {
    const double middle = median(values);
    std::vector<double> distances;
    for (const double value : values) distances.push_back(std::fabs(value - middle));
    return median(std::move(distances));
}

Spread spread_of(const std::vector<double>& values) {
    if (values.empty()) return {};
    const auto [min, max] = std::minmax_element(values.begin(), values.end());
    return {median(values), median_absolute_deviation(values), *min, *max};
}

Spread spread_of(std::span<const TimedRun> runs,
                 const std::function<double(const RenderStats&)>& figure) {
    std::vector<double> values;
    for (const RenderStats& run : runs) values.push_back(figure(run));
    return spread_of(values);
}

double timed_total(const RenderStats& run) {
    return run.phases.renderer.open + run.phases.renderer.build + picture_seconds(run);
}

double picture_seconds(const RenderStats& run) {
    const RendererTimes& times = run.phases.renderer;
    return run.phases.flatten + times.upload + times.trace + times.resolve + times.read_back;
}

double trace_seconds(const RenderStats& run) { return run.phases.renderer.trace; }

namespace {

CoreTimes core_times() {
    static const Stopwatch watch;
    cpu_set_t ours;
    if (sched_getaffinity(0, sizeof ours, &ours) != 0) return {watch.seconds(), -1, 0};
    std::ifstream stat("/proc/stat");
    return {watch.seconds(), used_seconds(stat, ours), processor_seconds()};
}

bool is_busy(double load) { return load / available_cores() >= 0.25; }

}  // namespace

double used_seconds(std::istream& stat, const cpu_set_t& which) {
    double ticks = 0;
    int cores = 0;
    for (std::string line; std::getline(stat, line);) {
        std::size_t core = 0;
        double user = 0, nice = 0, system = 0, idle = 0, wait = 0, irq = 0, softirq = 0, steal = 0;
        std::istringstream fields(line.starts_with("cpu") ? line.substr(3) : "");
        if (line.starts_with("cpu ") || !(fields >> core) || !CPU_ISSET(core, &which)) continue;
        fields >> user >> nice >> system >> idle >> wait >> irq >> softirq >> steal;
        ticks += user + nice + system + irq + softirq + steal;
        ++cores;
    }
    return cores < CPU_COUNT(&which) ? -1 : ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

double load_between(const CoreTimes& from, const CoreTimes& to) {
    if (from.used < 0 || to.used < 0) return -1;
    const double others = to.used - from.used - (to.own - from.own);
    return std::max(others / (to.wall - from.wall), 0.0);
}

double other_load() {
    static const CoreTimes first = core_times();
    static const double before = [] {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        return load_between(first, core_times());
    }();
    return std::max(before, load_between(first, core_times()));
}

std::string busy_text(double load) {
    if (!is_busy(load)) return "";
    return fmt::format(
        "busy machine (others use {:.1f} of {}, {:.2f} per core): do not quote timings", load,
        counted(static_cast<std::size_t>(available_cores()), "core"), load / available_cores());
}

Json machine_load_json(double load) {
    if (load < 0) return {{"load_before", nullptr}, {"load_per_core", nullptr}, {"busy", nullptr}};
    return {{"load_before", load},
            {"load_per_core", load / available_cores()},
            {"busy", is_busy(load)}};
}

namespace {

/// Why a case's newest picture is wrong: values that are not finite, or other bits than its earlier
/// runs or threads gave, or other counts of rays. Empty if it is right.
std::string what_is_wrong(const TimedCase& timed, const RenderStats& run) {
    if (const std::size_t count = run.error->non_finite; count > 0) {
        return counted(count, "pixel is", "pixels are") + " not finite";
    }
    for (const std::vector<TimedRun>* runs : {&timed.warm_up, &timed.repeats}) {
        if (runs->empty() || runs->front().image_hash == run.image_hash) continue;
        return fmt::format("the picture changes from run to run: {}, then {}",
                           hash_text(runs->front().image_hash), hash_text(run.image_hash));
    }
    if (!timed.right) return "";
    if (timed.right->image_hash != run.image_hash) {
        return fmt::format("image {}, but threads produce {}", hash_text(run.image_hash),
                           hash_text(timed.right->image_hash));
    }
    if (timed.right->rays == run.rays) return "";
    return fmt::format("it counts {} rays, but threads {}", run.rays.total(),
                       timed.right->rays.total());
}

/// Renders a case once more and keeps the run, unless it was stopped midway.
void render_once(TimedCase& timed, bool warm_up, const Stopwatch& watch) {
    const double started = watch.seconds();
    Scene scene = timed.scene->scene;
    apply_overrides(scene, timed.settings);
    RenderedPicture rendered = render_quietly(scene, timed.settings, timed.device);
    TimedRun run{std::move(rendered.stats), started};
    if (!run.complete()) return;
    run.scene.path = timed.scene->id.path;
    run.phases.load = timed.scene->load_seconds;
    run.phases.total = timed_total(run);
    run.error = image_error(clamped(std::move(rendered.picture)), clamped(*timed.reference));
    timed.why = what_is_wrong(timed, run);
    (warm_up ? timed.warm_up : timed.repeats).push_back(std::move(run));
    if (!timed.why.empty()) {
        timed.verdict = Verdict::wrong;
    } else if (!warm_up) {
        timed.verdict = Verdict::right;
    }
}

/// A device that fails ends its own case, not the others.
void try_once(TimedCase& timed, bool warm_up, const Stopwatch& watch) {
    try {
        render_once(timed, warm_up, watch);
    } catch (const Error& error) {
        timed.verdict = Verdict::failed;
        timed.why = first_line(error.what());
    }
}

/// Estimates the time left from the previous round.
void say_round(int round, int rounds, std::size_t pictures, double seconds_before) {
    if (round == 0) {
        return print_note("warm-up, " + counted(pictures, "picture"));
    }
    const auto left = static_cast<long>(std::ceil(seconds_before * (rounds - round + 1)));
    print_note(fmt::format("round {} of {}, {}, about {}:{:02} left", round, rounds,
                           counted(pictures, "picture"), left / 60, left % 60));
}

}  // namespace

std::vector<DeviceChoice> listed_devices(const std::vector<std::string>& specs) {
    std::vector<DeviceChoice> devices;
    const auto add = [&](const DeviceChoice& choice) {
        if (std::ranges::count(devices, choice.spec(), &DeviceChoice::spec) > 0) return;
        devices.push_back(choice);
    };
    std::optional<ClDeviceList> all;
    const auto listed = [&]() -> const ClDeviceList& {
        if (all) return *all;
        prepare_pocl(0);
        const DriverTask task(listing_devices);
        return all.emplace(list_cl_devices());
    };
    for (const std::string& text : specs) {
        const DeviceSpec spec = parse_device_specs(text).front();
        if (spec.kind == DeviceSpec::Kind::threads) {
            add(threads_choice(spec.threads));
        } else if (spec.kind != DeviceSpec::Kind::all) {
            add(choose_device(text, listed()));
        } else {
            add(threads_choice());
            for (const ClDevice& device : listed().devices) {
                if (device.unusable.empty()) {
                    add({.device = device});
                } else {
                    print_note("skipping " + device.name + ": " + device.unusable);
                }
            }
            print_notes(listed().problems);
        }
    }
    return devices;
}

TimedScene load_timed_scene(const std::string& path, const LightOverrides& light, bool quiet) {
    const Stopwatch watch;
    Scene scene = path.empty() ? load_default_scene(light) : load_scene(path, light);
    const double seconds = watch.seconds();
    if (!quiet) print_notes(scene.notes);
    const SceneId id{path.empty() ? default_scene_path : path, scene.name, scene_hash(scene)};
    return {id, std::move(scene), seconds};
}

RenderSettings timed_settings(RenderSettings settings) {
    settings.no_fallback = true;
    settings.self_test = false;
    return settings;
}

RenderedPicture render_quietly(const Scene& scene, const RenderSettings& settings,
                               const DeviceChoice& device, RenderCache* cache) {
    RenderEvents events;
    events.started = [](const TileQueue&) { install_stop_signals(); };
    events.driver_loaded = restore_stop_signals;
    if (is_worker()) events.progressed = note_worker_progress;
    const DriverTask task(device.use_threads ? "" : device.device.name);
    const auto devices = [&] { return std::vector{device}; };
    return render_picture(scene, settings, devices, events, stop_flag(), cache);
}

bool run_rounds(std::vector<TimedCase>& cases, int repeats, bool quiet) {
    const Stopwatch watch;
    Stopwatch round_watch;
    for (int round = 0; round <= repeats; ++round) {
        if (!quiet) say_round(round, repeats, cases.size(), round_watch.lap());
        for (TimedCase& timed : cases) {
            if (stop_flag() != 0) return false;
            if (timed.verdict == Verdict::wrong || timed.verdict == Verdict::failed) continue;
            try_once(timed, round == 0, watch);
        }
    }
    return stop_flag() == 0;
}

void say_busy(bool quiet) {
    const std::string text = busy_text(other_load());
    if (!quiet && !text.empty()) print_note(text);
}

}  // namespace rt
