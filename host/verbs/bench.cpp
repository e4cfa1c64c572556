// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <map>
#include <set>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/parallel.h"
#include "host/image/output_path.h"
#include "host/measure/baseline.h"
#include "host/measure/machine_load.h"
#include "host/print/print_bench.h"
#include "host/print/print_run.h"
#include "host/print/print_stats.h"
#include "host/print/result_file.h"
#include "host/process/stop_signal.h"
#include "host/render/stopwatch.h"
#include "host/render/threads_renderer.h"
#include "host/scene/scene_file.h"
#include "host/scene/scene_hash.h"
#include "host/verbs/ablation.h"
#include "host/verbs/default_scene.h"
#include "host/verbs/device_list.h"
#include "host/verbs/measure.h"
#include "host/verbs/timing_loop.h"
#include "host/verbs/verbs.h"

namespace rt {

namespace {

struct LoadedScene {
    std::string path;
    Scene scene;
    double load_seconds = 0;
};

/// The rows of one bench, and the scenes and references they point to.
class Plan {
   public:
    explicit Plan(const BenchOptions& options)
        : options_(options), devices_(listed_devices(options.devices)) {
        if (options.scenes.empty()) {
            say("no scene given: using the built-in cornell-box");
            scenes_.push_back({default_scene_path, load_default_scene(options.light), 0});
        }
        for (const std::string& path : options.scenes) {
            const Stopwatch watch;
            Scene scene = load_scene(path, options.light);
            const double seconds = watch.seconds();
            if (!options.quiet) print_notes(scene.notes);
            scenes_.push_back({path, std::move(scene), seconds});
        }
        say_devices_without_double();
    }

    /// Renders the references and lists the rows. False when stopped.
    bool make(BenchResult& result) {
        for (const LoadedScene& loaded : scenes_) {
            for (const PictureSize& size : options_.sizes) {
                for (const AaMode& aa : options_.aa) {
                    RenderSettings picture = timed_settings();
                    picture.size = size;
                    picture.aa = aa;
                    if (!add_reference(loaded, picture, result)) return false;
                    add_rows(loaded, picture);
                }
            }
        }
        return true;
    }

    std::vector<BenchCase> asked;  ///< the rows
    std::vector<TimedCase> cases;  ///< what it takes to time each

   private:
    void say(const std::string& line) const {
        if (!options_.quiet) print_note(line);
    }

    bool wants_double() const {
        return std::find(options_.precisions.begin(), options_.precisions.end(),
                         Precision::float64) != options_.precisions.end();
    }

    void say_devices_without_double() const {
        for (const ListedDevice& device : devices_) {
            if (wants_double() && !device.has_double) say(device.name + " has no double precision");
        }
    }

    bool add_reference(const LoadedScene& loaded, RenderSettings picture, BenchResult& result) {
        picture.precision = Precision::float64;
        Scene scene = loaded.scene;
        apply_overrides(scene, picture);
        RenderedPicture rendered = render_quietly(scene, picture, threads_choice());
        if (!rendered.stats.complete()) return false;
        rendered.stats.scene.path = loaded.path;
        rendered.stats.phases.load = loaded.load_seconds;
        rendered.stats.phases.total = timed_total(rendered.stats);
        hashes_[Precision::float64] = rendered.stats.image_hash;
        result.references.push_back(rendered.stats);
        references_.push_back(std::move(rendered.picture));
        picture.precision = Precision::float32;
        const RenderedPicture in_float = render_quietly(scene, picture, threads_choice());
        hashes_[Precision::float32] = in_float.stats.image_hash;
        return in_float.stats.complete();
    }

    void add_rows(const LoadedScene& loaded, RenderSettings picture) {
        for (const Precision precision : options_.precisions) {
            picture.precision = precision;
            for (const ListedDevice& device : devices_) {
                if (precision == Precision::float64 && !device.has_double) continue;
                if (options_.ablate) {
                    add_ablation(loaded, picture, device);
                } else if (device.is_threads) {
                    add_threads_rows(loaded, picture, device);
                } else {
                    add_row(loaded, picture, device);
                }
            }
        }
    }

    /// threads: 1 to N threads with every schedule; threads:K: only K. Then scalar threads, to show
    /// what vectors gain. The buffers schedule runs at most one thread per sample of a pixel.
    void add_threads_rows(const LoadedScene& loaded, RenderSettings picture,
                          const ListedDevice& device) {
        const int most = options_.threads > 0 ? options_.threads : available_cores();
        const int first = device.threads > 0 ? device.threads : 1;
        const int last = device.threads > 0 ? device.threads : most;
        for (const Schedule schedule : options_.schedules) {
            for (int threads = first; threads <= last; ++threads) {
                const int running = thread_count({threads, schedule}, picture.aa->samples());
                if (running < threads) break;
                picture.schedule = schedule;
                add_row(loaded, picture, with_threads(device, threads));
            }
        }
        if (!options_.scalar) return;
        picture.schedule = Schedule::tiles;
        picture.lanes = 1;
        for (const int threads : std::set{first, last}) {
            add_row(loaded, picture, with_threads(device, threads));
        }
    }

    static ListedDevice with_threads(ListedDevice device, int threads) {
        device.spec = fmt::format("threads:{}", threads);
        device.threads = device.choice.threads = threads;
        return device;
    }

    /// The picture with default settings, then with each change.
    void add_ablation(const LoadedScene& loaded, const RenderSettings& picture,
                      const ListedDevice& device) {
        ListedDevice used = device;
        if (device.is_threads && device.threads == 0) {
            used =
                with_threads(device, options_.threads > 0 ? options_.threads : available_cores());
        }
        add_row(loaded, picture, used);
        Scene scene = loaded.scene;
        apply_overrides(scene, picture);
        for (const Change& change : changes_to_measure(scene, device, picture.precision)) {
            RenderSettings changed = picture;
            change.make(changed);
            add_row(loaded, changed, used, change.what);
        }
    }

    void add_row(const LoadedScene& loaded, const RenderSettings& picture,
                 const ListedDevice& device, const std::string& change = "") {
        BenchCase& row = asked.emplace_back();
        row.scene_path = loaded.path;
        row.scene_name = loaded.scene.name;
        row.scene_hash = scene_hash(loaded.scene);
        row.width = picture.size->width;
        row.height = picture.size->height;
        row.aa = *picture.aa;
        row.double_precision = picture.precision == Precision::float64;
        row.uses_threads = device.is_threads;
        row.device = device.spec;
        row.device_name = device.name;
        row.threads = device.threads;
        row.change = change;
        if (device.is_threads) {
            row.schedule =
                picture.lanes == 1 ? "scalar" : name_of(schedule_names, picture.schedule);
        }
        TimedCase& timed = cases.emplace_back();
        timed.scene = &loaded.scene;
        timed.reference = &references_.back();
        timed.path = loaded.path;
        timed.device = device.choice;
        timed.settings = picture;
        timed.expected_hash = hashes_.at(picture.precision);
        timed.load_seconds = loaded.load_seconds;
    }

    const BenchOptions& options_;
    const std::vector<ListedDevice> devices_;
    std::deque<LoadedScene> scenes_;  // deques: rows point into them
    std::deque<Picture> references_;
    std::map<Precision, std::uint64_t> hashes_;  ///< of the latest reference, and in float
};

void say_bad_rows(const BenchResult& result) {
    for (const auto* rows : {&result.rows, &result.ablation}) {
        for (const BenchRow& row : *rows) {
            if (row.verdict != Verdict::wrong && row.verdict != Verdict::failed) continue;
            print_note(fmt::format("{} ({}){}: {}: {}", key_of(row.asked), row.asked.device_name,
                                   row.asked.change.empty() ? "" : ", " + row.asked.change,
                                   to_string(row.verdict), row.why));
        }
    }
}

/// Whether any row has become slower; reports each on stderr.
bool has_regressed(const BenchResult& result, const Baseline& baseline, double max_regress) {
    const auto found = regressions(result, baseline, max_regress);
    for (const Regression& regression : found) {
        print_note("slower: " + to_string(regression));
    }
    return !found.empty();
}

}  // namespace

BenchResult measure_bench(const BenchOptions& options, const Baseline* baseline) {
    BenchResult result;
    result.repeats_asked = options.repeats;
    Plan plan(options);
    say_busy(options.quiet);
    result.interrupted = !plan.make(result);
    if (baseline != nullptr && !result.interrupted) check_baseline(plan.asked, *baseline);
    if (!result.interrupted) {
        result.interrupted = !run_rounds(plan.cases, options.repeats, options.quiet);
    }
    std::vector<BenchRow>& rows = options.ablate ? result.ablation : result.rows;
    for (std::size_t i = 0; i < plan.cases.size(); ++i) {
        rows.push_back({std::move(plan.cases[i]), plan.asked[i]});
    }
    judge_ablation(result);
    result.load_before = other_load();
    return result;
}

int run_bench(const BenchOptions& options) {
    check_result_path(options.results.json, json_start("mirrorball-bench"));
    check_output_is_no_input(options.results.json, {options.baseline});
    check_result_path(options.results.csv, run_csv_header());
    check_outputs_differ({options.results.json, options.results.csv});
    Baseline baseline;
    if (!options.baseline.empty()) baseline = load_baseline(options.baseline);
    const FreshKernelCache kernels;
    const BenchResult result =
        measure_bench(options, options.baseline.empty() ? nullptr : &baseline);
    if (!options.results.take_stdout()) print_result(bench_text(result));
    write_result(options.results.json, json_text(bench_json(result)));
    write_result(options.results.csv, bench_csv(result));
    say_bad_rows(result);
    if (result.interrupted) return 128 + stop_flag();
    const bool slower =
        !options.baseline.empty() && has_regressed(result, baseline, options.max_regress);
    if (slower || any_row(result, Verdict::wrong)) return static_cast<int>(ExitCode::different);
    return static_cast<int>(any_row(result, Verdict::failed) ? ExitCode::device : ExitCode::done);
}

}  // namespace rt
