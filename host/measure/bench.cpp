// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <map>
#include <utility>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/parallel.h"
#include "host/record/record.h"
#include "host/render/threads_renderer.h"
#include "host/scene/scene.h"

namespace rt {

namespace {

bool same_picture(const BenchCase& a, const BenchCase& b) {
    return a.scene.path == b.scene.path && a.scene.hash == b.scene.hash && a.picture == b.picture;
}

const BenchRow* one_thread_row(const BenchResult& result, const BenchCase& asked,
                               const std::string& schedule) {
    const auto row = std::ranges::find_if(result.rows, [&](const BenchRow& r) {
        return r.has_figures() && r.asked.uses_threads() && r.asked.threads == 1 &&
               r.asked.schedule == schedule && same_picture(r.asked, asked);
    });
    return row == result.rows.end() ? nullptr : &*row;
}

const BenchRow* base_of(const BenchResult& result, const BenchCase& asked) {
    if (asked.uses_threads()) return one_thread_row(result, asked, asked.schedule);
    const BenchRow* const tiles = one_thread_row(result, asked, "tiles");
    return tiles != nullptr ? tiles : one_thread_row(result, asked, "buffers");
}

std::optional<BenchFigures> figures_of(const BenchResult& result, const BenchRow& row) {
    if (!row.has_figures()) return std::nullopt;
    BenchFigures figures;
    figures.trace = spread_of(row.repeats, trace_seconds);
    figures.total = spread_of(row.repeats, timed_total);
    const RenderStats& run = row.repeats.front();
    if (figures.trace.median > 0) {
        figures.rays_per_second = static_cast<double>(run.rays.total()) / figures.trace.median;
    }
    figures.threads = run.device.threads;
    const BenchRow* const base = base_of(result, row.asked);
    if (base == nullptr || figures.total.median <= 0) return figures;
    const double base_total = spread_of(base->repeats, timed_total).median;
    const double base_trace = spread_of(base->repeats, trace_seconds).median;
    figures.speed_up = base_total / figures.total.median;
    if (figures.trace.median > 0) figures.trace_speed_up = base_trace / figures.trace.median;
    if (!row.asked.uses_threads()) return figures;
    figures.parallel_fraction = parallel_fraction(base_trace, base_total);
    figures.amdahl = amdahl_speed_up(*figures.parallel_fraction, figures.threads);
    figures.over_amdahl = *figures.speed_up - *figures.amdahl;
    return figures;
}

}  // namespace

void BenchResult::judge() {
    for (BenchRow& row : rows) row.figures = figures_of(*this, row);
}

std::string key_of(const BenchCase& asked) {
    const PictureSpec& picture = asked.picture;
    return fmt::format("{} {}x{} {} {} {} {}{}{}", hash_text(asked.scene.hash), picture.width,
                       picture.height, to_string(picture.aa), to_string(picture.precision),
                       asked.device, asked.uses_threads() ? "" : asked.device_name,
                       asked.schedule.empty() ? "" : " ", asked.schedule);
}

double parallel_fraction(double trace_seconds, double total_seconds) {
    return total_seconds > 0 ? trace_seconds / total_seconds : 0;
}

double amdahl_speed_up(double parallel_fraction, int threads) {
    return 1 / ((1 - parallel_fraction) + parallel_fraction / threads);
}

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
        right_[Precision::float64] = rendered.stats;
        result.references.push_back({{std::move(rendered.stats), {}}});
        references_.push_back(std::move(rendered.picture));
        picture.precision = Precision::float32;
        picture.estimate = false;
        right_[Precision::float32] = render_quietly(scene, picture, threads_choice()).stats;
        return right_[Precision::float32].complete();
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
            if (schedule == Schedule::buffers && !picture.aa->fixed_samples()) continue;
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
        timed.right = right_.at(picture.precision);
    }

    const BenchOptions& options_;
    const std::vector<DeviceChoice> devices_;
    std::deque<TimedScene> scenes_;  // deques: rows point into them
    std::deque<Picture> references_;
    PictureSpec spec_;                        ///< of the latest reference
    std::map<Precision, RenderStats> right_;  ///< of the latest reference, and in float
};

}  // namespace

BenchResult measure_bench(const BenchOptions& options) {
    BenchResult result;
    result.repeats_asked = options.repeats;
    Plan plan(options);
    say_busy(options.quiet);
    result.interrupted = !plan.make(result);
    if (!result.interrupted && plan.cases.empty()) {
        usage_error(
            "nothing to measure: --aa has no sample buffers, or no device has double precision");
    }
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
