// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <span>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/image/atomic_file.h"
#include "host/measure/bench.h"
#include "host/measure/machine_load.h"
#include "host/print/environment_json.h"
#include "host/print/print_bench.h"
#include "host/print/print_converge.h"
#include "host/print/result_file.h"
#include "host/process/stop_signal.h"
#include "host/report/report_page.h"
#include "host/scene/scene_file.h"
#include "host/verbs/converge_reference.h"
#include "host/verbs/device_list.h"
#include "host/verbs/measure.h"
#include "host/verbs/report_settings.h"
#include "host/verbs/timing_loop.h"
#include "host/verbs/verbs.h"

namespace rt {

namespace {

constexpr const char* page_start = "<!DOCTYPE html>";

/// A signal has stopped the measurements.
struct Stopped {};

/// Measures one scene for the page.
class SceneStudy {
   public:
    SceneStudy(const ReportOptions& options, const std::string& path)
        : options_(options), path_(path), scene_(load_scene(path)) {
        if (options.size) set_image_size(scene_, options.size->width, options.size->height);
        if (to_string(scene_.aa) == "none") scene_.aa = grid_aa(2);
    }

    /// Fills in the study part by part; when it throws Stopped, the finished parts remain.
    void run(ReportScene& study) {
        study.has_pictures = study.complete = false;
        say(1, "timings");
        study.bench = measure_bench(bench_settings(options_, path_, scene_));
        study.bench_json = bench_json(study.bench);
        stop_if(study.bench.interrupted);
        say(2, "error against run time");
        const ConvergeOptions sweep = converge_settings(options_, path_, scene_);
        study.converge = measure_converge(sweep);
        study.converge_json = converge_json(study.converge);
        stop_if(study.converge.interrupted);
        const ConvergedPicture converged = converged_picture(scene_, sweep);
        stop_if(!converged.complete);
        study.reference = clamped(converged.picture);
        say(3, "pictures, and what leaving features out saves");
        study.plain = picture(grid_aa(1), study.reference);
        study.smooth = picture(scene_.aa, study.reference);
        study.has_pictures = true;
        study.trial = trial(study);
        study.complete = true;
    }

   private:
    void say(int step, const char* what) const {
        if (options_.quiet) return;
        print_note(fmt::format("{}, step {} of 3: {}", path_, step, what));
    }

    static void stop_if(bool interrupted) {
        if (interrupted || stop_flag() != 0) throw Stopped{};
    }

    static RenderSettings picture_settings(const AaMode& aa) {
        RenderSettings settings = timed_settings();
        settings.aa = aa;
        return settings;
    }

    /// The first OpenCL device named, else the first device.
    ListedDevice device() const {
        const std::vector<ListedDevice> devices = listed_devices(options_.devices);
        const auto opencl = std::find_if(devices.begin(), devices.end(),
                                         [](const ListedDevice& d) { return !d.is_threads; });
        return opencl == devices.end() ? devices.front() : *opencl;
    }

    ReportPicture picture(const AaMode& aa, const Picture& reference) const {
        Scene scene = scene_;
        const RenderSettings settings = picture_settings(aa);
        apply_overrides(scene, settings);
        RenderedPicture rendered = render_quietly(scene, settings, device().choice);
        stop_if(!rendered.stats.complete());
        rendered.stats.scene.path = path_;
        rendered.stats.error = image_error(clamped(rendered.picture), reference);
        return {std::move(rendered.picture), std::move(rendered.stats)};
    }

    std::optional<FeatureTrial> trial(const ReportScene& study) const {
        if (device().is_threads) return std::nullopt;
        std::vector<TimedCase> cases(2);
        for (TimedCase& timed : cases) {
            timed.scene = &scene_;
            timed.reference = &study.reference;
            timed.judge = judge_estimate;
            timed.path = path_;
            timed.device = device().choice;
            timed.settings = picture_settings(scene_.aa);
        }
        cases[1].settings.all_features = true;
        stop_if(!run_rounds(cases, std::max(options_.repeats, 9), true));
        if (cases[0].repeats.empty() || cases[1].repeats.empty()) return std::nullopt;
        return FeatureTrial{cases[0].repeats, cases[1].repeats, cold_build(study.bench),
                            cold_of(cases[1].warm_up)};
    }

    /// The run that compiled the kernels this scene needs: the first in float on OpenCL.
    static std::optional<RenderStats> cold_build(const BenchResult& bench) {
        for (const BenchRow& row : bench.rows) {
            if (row.asked.uses_threads || row.asked.double_precision) continue;
            if (auto cold = cold_of(row.warm_up)) return cold;
        }
        return std::nullopt;
    }

    static std::optional<RenderStats> cold_of(const std::vector<RenderStats>& runs) {
        for (const RenderStats& run : runs) {
            if (run.phases.renderer.build > 0) return run;
        }
        return std::nullopt;
    }

    const ReportOptions& options_;
    const std::string path_;
    Scene scene_;
};

/// The stress suite on the report's devices.
StressResult stress_result(const ReportOptions& options) {
    StressOptions stress;
    stress.devices = options.devices;
    stress.quick = options.quick;
    stress.keep_pictures = true;
    stress.quiet = options.quiet;
    return measure_stress(stress);
}

std::string today() {
    const time_t now = time(nullptr);
    tm utc{};
    char text[32] = "";
    gmtime_r(&now, &utc);
    strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &utc);
    return text;
}

/// 1 if any picture is wrong, whatever the other figures are.
int verdict(const Report& report) {
    const bool wrong =
        std::any_of(report.scenes.begin(), report.scenes.end(), [](const ReportScene& scene) {
            return any_row(scene.bench, Verdict::wrong) ||
                   std::any_of(scene.converge.points.begin(), scene.converge.points.end(),
                               [](const ConvergePoint& p) { return p.verdict == Verdict::wrong; });
        });
    return static_cast<int>(wrong ? ExitCode::different : ExitCode::done);
}

/// Runs until a signal stops it; scenes with nothing finished are left out.
void measure(const ReportOptions& options, Report& report) {
    try {
        for (const std::string& path : options.scenes) {
            report.scenes.emplace_back();
            SceneStudy(options, path).run(report.scenes.back());
        }
        if (!options.stress) return;
        StressResult stress = stress_result(options);
        const bool stopped = stress.interrupted;
        if (!stress.families.empty()) report.stress = std::move(stress);
        if (stopped) throw Stopped{};
    } catch (const Stopped&) {
        report.stopped = stop_reason();
        const ReportScene& last = report.scenes.back();
        if (!last.has_pictures && last.bench.references.empty()) report.scenes.pop_back();
    }
}

}  // namespace

int run_report(const ReportOptions& options) {
    check_result_path(options.output, page_start);
    for (const std::string& path : options.scenes) load_scene(path);
    const FreshKernelCache kernels;
    Report report;
    report.date = today();
    report.commands = report_commands(options);
    report.load_before = other_load();
    measure(options, report);
    if (report.scenes.empty()) {
        print_note(stop_reason() + " before any picture was finished; no page written");
        return 128 + stop_flag();
    }
    report.environment = environment_json();
    const std::string page = report_page(report);
    write_file_atomically(options.output, std::as_bytes(std::span(page)));
    if (!options.quiet) {
        print_message(fmt::format("{}: {} kB{}\n", options.output, (page.size() + 999) / 1000,
                                  report.stopped.empty() ? "" : ", incomplete: " + report.stopped));
    }
    return report.stopped.empty() ? verdict(report) : 128 + stop_flag();
}

}  // namespace rt
