// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <map>

#include "host/base/console.h"
#include "host/base/parallel.h"
#include "host/measure/bench.h"
#include "host/measure/machine_load.h"
#include "host/measure/timing.h"
#include "host/render/stopwatch.h"
#include "host/render/threads_renderer.h"
#include "host/scene/scene.h"
#include "host/scene/scene_file.h"

namespace rt {

namespace {

/// The rows of one bench, and the scenes and references they point to.
class Plan {
   public:
    explicit Plan(const BenchOptions& options)
        : options_(options), devices_(listed_devices(options.devices)) {
        if (options.scenes.empty()) {
            say("no scene given: using the built-in cornell-box");
            scenes_.push_back(load_timed_scene("", options.light, options.quiet));
        }
        for (const std::string& path : options.scenes) {
            scenes_.push_back(load_timed_scene(path, options.light, options.quiet));
        }
        say_devices_without_double();
    }

    /// Renders the references and lists the rows. False when stopped.
    bool make(BenchResult& result) {
        for (const TimedScene& loaded : scenes_) {
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

    void say_devices_without_double() const {
        if (std::ranges::count(options_.precisions, Precision::float64) == 0) return;
        for (const DeviceChoice& device : devices_) {
            if (!device.has_double()) say(device.name() + " has no double precision");
        }
    }

    int most_threads() const { return options_.threads > 0 ? options_.threads : available_cores(); }

    bool add_reference(const TimedScene& loaded, RenderSettings picture, BenchResult& result) {
        picture.precision = Precision::float64;
        picture.estimate = true;
        Scene scene = loaded.scene;
        apply_overrides(scene, picture);
        spec_ = picture_spec(scene, picture);
        RenderedPicture rendered = render_quietly(scene, picture, threads_choice());
        if (!rendered.stats.complete()) return false;
        rendered.stats.scene.path = loaded.id.path;
        rendered.stats.phases.load = loaded.load_seconds;
        rendered.stats.phases.total = timed_total(rendered.stats);
        hashes_[Precision::float64] = rendered.stats.image_hash;
        result.references.push_back({{std::move(rendered.stats), {}}});
        references_.push_back(std::move(rendered.picture));
        picture.precision = Precision::float32;
        picture.estimate = false;
        const RenderedPicture in_float = render_quietly(scene, picture, threads_choice());
        hashes_[Precision::float32] = in_float.stats.image_hash;
        return in_float.stats.complete();
    }

    void add_rows(const TimedScene& loaded, RenderSettings picture) {
        for (const Precision precision : options_.precisions) {
            picture.precision = precision;
            for (const DeviceChoice& device : devices_) {
                if (precision == Precision::float64 && !device.has_double()) continue;
                if (device.use_threads) {
                    add_threads_rows(loaded, picture, device);
                } else {
                    add_row(loaded, picture, device);
                }
            }
        }
    }

    /// threads: 1 to N threads with every schedule; threads:K: only K. Scalar threads show what
    /// vectors gain, with one thread and with all. The buffers schedule runs at most one thread per
    /// sample of a pixel.
    void add_threads_rows(const TimedScene& loaded, RenderSettings picture,
                          const DeviceChoice& device) {
        const int first = device.threads > 0 ? device.threads : 1;
        const int last = device.threads > 0 ? device.threads : most_threads();
        for (const auto& [schedule, is_scalar] : options_.ways) {
            picture.schedule = schedule;
            picture.kernels.lanes = is_scalar ? 1 : 0;
            for (int threads = first; threads <= last; ++threads) {
                if (thread_count({threads, schedule}, picture.aa->samples()) < threads) break;
                if (is_scalar && threads != first && threads != last) continue;
                add_row(loaded, picture, threads_choice(threads));
            }
        }
    }

    void add_row(const TimedScene& loaded, const RenderSettings& picture,
                 const DeviceChoice& device) {
        BenchCase& row = asked.emplace_back();
        row.scene = loaded.id;
        row.picture = spec_;
        row.picture.precision = picture.precision;
        row.device = device.spec();
        row.device_name = device.name();
        row.threads = device.threads;
        if (device.use_threads) {
            row.schedule = picture.kernels.lanes == 1 ? "scalar" : to_string(picture.schedule);
        }
        TimedCase& timed = cases.emplace_back();
        timed.scene = &loaded;
        timed.reference = &references_.back();
        timed.device = device;
        timed.settings = picture;
        timed.expected_hash = hashes_.at(picture.precision);
    }

    const BenchOptions& options_;
    const std::vector<DeviceChoice> devices_;
    std::deque<TimedScene> scenes_;  // deques: rows point into them
    std::deque<Picture> references_;
    PictureSpec spec_;                           ///< of the latest reference
    std::map<Precision, std::uint64_t> hashes_;  ///< of the latest reference, and in float
};

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
    for (std::size_t i = 0; i < plan.cases.size(); ++i) {
        TimedRuns& runs = plan.cases[i];
        result.rows.push_back({std::move(runs), plan.asked[i], {}});
    }
    result.judge();
    result.load_before = other_load();
    return result;
}

}  // namespace rt
