// SPDX-License-Identifier: Apache-2.0
#include "host/picture/render_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <utility>

#include "host/base/error.h"
#include "host/base/memory.h"
#include "host/base/parallel.h"
#include "host/flatten/flat_scene.h"
#include "host/picture/crew.h"
#include "host/picture/picture_journal.h"

namespace rt {

namespace {

using Devices = std::vector<DeviceChoice>;

SceneStats scene_stats(const Scene& scene) {
    SceneStats stats;
    stats.name = scene.name;
    stats.hash = scene_hash(scene);
    stats.lights = scene.lights.size();
    stats.materials = scene.materials.size();
    return stats;
}

bool has_opencl(const Devices& devices) {
    return !std::ranges::all_of(devices, &DeviceChoice::use_threads);
}

/// Of a pixel in a picture's file, which grows by doubling as it is encoded.
constexpr std::size_t file_bytes = 12;

/// Tile size in pixels for checking a picture that was not rendered in this run.
constexpr PictureSize final_tile{32, 32};

/// What is known of a picture's error before it is rendered again with more samples.
struct ErrorControl {
    std::optional<ControlPixels> pixels;  ///< empty: to be chosen
    std::optional<AaMode> finer;  ///< what should reach settings.target_rmse, if it does not
};

/// One flattened scene being rendered in the precision of T, and the figures gathered so far.
template <typename T>
class Job {
   public:
    Job(const Scene& scene, const RenderSettings& settings, const RenderEvents& events,
        const StopFlag& stop, RenderCache& cache, ErrorControl& control)
        : settings_(settings),
          events_(events),
          stop_(stop),
          control_(control),
          is_first_(!std::exchange(cache.has_warned, true)),
          picture_(picture_spec(scene, settings)) {
        FlattenOptions options;
        options.hierarchies = settings.hierarchies;
        options.caster_lists = settings.caster_lists;
        const Stopwatch watch;
        auto figures = std::async(scene_stats, std::cref(scene));
        scene_ = std::make_shared<const FlatScene<T>>(flatten<T>(scene, options));
        stats_.phases.flatten = watch.seconds();
        stats_.scene = figures.get();
        maker_.emplace(
            CrewMaker<T>{scene_, settings_, picture_.aa, cache.devices, events.driver_loaded});
        stats_.scene.smooth_triangles = scene_->vertex_normals.size();
        stats_.scene.bytes = scene_->bytes();
        stats_.scene.flatten = scene_->stats;
        stats_.scene.features = stats_.scene.compiled = scene_->features;
        stats_.picture = picture_;
        stats_.kernels = settings.kernels;
        stats_.hierarchies = settings.hierarchies;
        stats_.caster_lists = settings.caster_lists;
    }

    RenderedPicture run(Devices devices, double wait_seconds) {
        is_exact_ =
            settings_.math == Math::strict && inexact_names(devices, precision_of<T>).empty();
        if (!is_exact_) std::erase_if(devices, [](const auto& choice) { return choice.is_helper; });
        if (is_first_) warn_of(devices);
        journal_.emplace(settings_, stats_, *scene_, devices, warn_);
        stats_.resumed = journal_->share_known();
        if (journal_->is_finished()) {
            film_ = journal_->take_film();
            tile_ = final_tile;
            stats_.device = stats_of({maker_->members(devices), warn_}, devices);
        } else {
            render_by(devices);
        }
        if (stats_.complete()) check_again(devices);
        const auto is_finite = [](T value) { return std::isfinite(value); };
        if (stats_.complete() && settings_.estimate && std::ranges::all_of(film_.rgb, is_finite)) {
            estimate(devices);
        }
        journal_->end(stats_.complete());
        stats_.phases.renderer.open += wait_seconds;
        return finished_picture();
    }

   private:
    void warn_of(const Devices& devices) const {
        for (const DeviceChoice& choice : devices) {
            warn_of_ignored_settings(choice, settings_, picture_.aa, events_);
            if (!choice.note.empty()) warn_(choice.note);
        }
        if (!is_exact_ && devices.size() > 1) {
            warn_(joined_names(devices) + " may round differently, and share this picture");
        }
    }

    void render_by(const Devices& devices) {
        Crew<T> crew(maker_->members(devices), warn_);
        try {
            if (events_.opening && has_opencl(devices)) events_.opening(joined_names(devices));
            crew.open();
            render_with(crew);
        } catch (const Error& error) {
            const bool can_replace = !settings_.no_fallback && has_opencl(devices);
            if (!can_replace || error.exit_code() != ExitCode::device) throw;
            warn_(error.what());
            return replace(joined_names(devices), crew.shares(), {threads_choice()});
        }
        stats_.shares = crew.shares();
        stats_.device = stats_of(crew, devices);
    }

    /// Of several devices, only their names.
    static DeviceStats stats_of(const Crew<T>& crew, const Devices& devices) {
        if (devices.size() == 1) return crew.stats();
        DeviceStats stats;
        stats.name = joined_names(devices);
        return stats;
    }

    /// Has threads render what the journal lacks, in place of devices that did these shares. It
    /// lacks everything where the devices may round differently.
    void replace(const std::string& devices, std::vector<DeviceShare> shares,
                 const Devices& threads) {
        warn_("rendering on threads instead");
        settings_.kernels.lanes = 0;  // was for the devices
        if (journal_->has_begun()) settings_.fresh = false;
        film_ = Film<T>(0, 0);  // makes room for the journal's
        journal_.emplace(settings_, stats_, *scene_, threads, warn_);
        stats_.resumed = journal_->share_known();
        render_by(threads);
        shares.push_back(stats_.shares.front());
        stats_.shares = std::move(shares);
        stats_.device.fallback_from = devices;
    }

    /// Renders the region; a device that fails is left out afterwards.
    void render_with(Crew<T>& crew) {
        constexpr std::size_t floats = 3 * sizeof(float);
        constexpr std::size_t copy = sizeof(T) == sizeof(float) ? 0 : floats;
        const std::size_t viewers = events_.rendered ? 2 * floats : 0;  // LivePicture's
        check_memory(static_cast<std::uint64_t>(region_.pixels()) *
                         (3 * sizeof(T) + copy + file_bytes + viewers),
                     fmt::format("the film of {}x{} pixels, including its file,", region_.width,
                                 region_.height),
                     "reduce --size, or render parts with --crop");
        film_ = journal_->take_film();
        tile_ = tile_size(crew);
        if (events_.began) events_.began(region_.width, region_.height);
        if (stats_.resumed > 0) report_rendered(region_);
        journal_->begin(film_);
        TileQueue queue(journal_->tiles(tile_.width, tile_.height), stop_,
                        [this](const Rect& tile) { finish_tile(tile); });
        if (events_.started) events_.started(queue);
        try {
            crew.render(queue, region_, film_);
        } catch (...) {
            if (events_.ended) events_.ended();
            journal_->end(false);
            throw;
        }
        if (events_.ended) events_.ended();
        stats_.phases.renderer = crew.times();
        stats_.rays = queue.rays();
        stats_.tiles = queue.tiles().size();
        stats_.tiles_finished = queue.tiles_finished();
    }

    void finish_tile(const Rect& tile) {
        journal_->tile_finished(tile);
        report_rendered(tile);
        if (events_.progressed) events_.progressed();
    }

    /// Reports the pixels of a part of the region to our caller.
    void report_rendered(const Rect& part) const {
        if (!events_.rendered) return;
        events_.rendered({part.x - region_.x, part.y - region_.y, part.width, part.height},
                         as_floats(part_of(film_, region_, part)));
    }

    /// The requested tile, reduced to the region and to the renderer's limit.
    PictureSize tile_size(const Renderer<T>& renderer) const {
        const auto [own, most_pixels] = renderer.tile_sizes(region_.width);
        const PictureSize asked = settings_.tile.value_or(PictureSize{own.width, own.height});
        const auto most = static_cast<int>(std::min(most_pixels, region_.pixels()));
        const int width = std::min({asked.width, region_.width, most});
        return {width, std::min({asked.height, region_.height, most / width})};
    }

    /// Traces a share of the tiles again, if requested; if any differ, the whole picture on
    /// threads.
    void check_again(const Devices& devices) {
        if (settings_.check <= 0 || (!has_opencl(devices) && stats_.resumed == 0)) return;
        const TileCheck check = check_tiles(*scene_, settings_.kernels.isa,
                                            journal_->shared_tiles(tile_.width, tile_.height),
                                            settings_.check, region_, film_, stop_);
        if (check.wrong_tiles == 0 && stop_ == 0) stats_.tiles_checked = check.tiles;
        if (check.wrong_tiles == 0) return;
        const std::string wrong = fmt::format("{} of {} tiles differ when traced again on threads",
                                              check.wrong_tiles, check.tiles);
        const std::string by = stats_.resumed == 0   ? stats_.device.name
                               : has_opencl(devices) ? stats_.device.name + " or the journal"
                                                     : "the journal";
        const std::string what = by + ": " + wrong;
        journal_->discard();
        if (settings_.no_fallback) throw Error(ExitCode::device, what);
        warn_(what);
        std::vector<DeviceShare> shares = stats_.shares;
        for (DeviceShare& share : shares) share.failure = wrong;
        replace(by, std::move(shares), has_opencl(devices) ? Devices{threads_choice()} : devices);
    }

    /// Estimates the picture's error, and looks for a mode that reaches the target, on as many
    /// threads as are to render; no estimate if stopped.
    void estimate(const Devices& devices) {
        const Stopwatch watch;
        const double target = settings_.target_rmse;
        ThreadsOptions threads{settings_.threads};
        for (const DeviceChoice& choice : devices) {
            threads.threads = std::max(threads.threads, choice.threads);
        }
        threads.kernels.isa = settings_.kernels.isa;
        const bool is_finer = control_.pixels.has_value();
        const ErrorEstimator<T> estimator{*scene_, region_, threads, stop_};
        if (!is_finer) control_.pixels = estimator.trace_controls(picture_.aa, film_);
        if (!control_.pixels) return;
        stats_.estimate = control_.pixels->estimate_of(film_);
        if (target > 0 && !is_finer && !stats_.estimate->reaches(target)) {
            control_.finer = estimator.mode_to_reach(target, picture_.aa, *control_.pixels);
            if (control_.finer == picture_.aa) control_.finer.reset();  // no mode is
        }
        stats_.estimate->target = target;
        stats_.estimate->seconds = watch.seconds();
    }

    RenderedPicture finished_picture() {
        stats_.scene.compiled = stats_.scene.features | stats_.device.kernels;
        stats_.image_hash = hash_of(film_);
        RenderedPicture rendered;
        rendered.picture.width = film_.width;
        rendered.picture.height = film_.height;
        rendered.picture.pixels = as_floats(std::move(film_));
        stats_.non_finite = count_non_finite(rendered.picture);
        rendered.stats = stats_;
        rendered.journal = journal_->file();
        return rendered;
    }

    RenderSettings settings_;
    const RenderEvents& events_;
    const StopFlag& stop_;
    ErrorControl& control_;
    const bool is_first_;        ///< of the cache's pictures
    const PictureSpec picture_;  ///< requested
    const Rect& region_ = picture_.region;
    bool is_exact_ = true;  ///< threads would give the same bits as the devices
    const std::function<void(const std::string& line)> warn_ = [this](const std::string& line) {
        if (events_.message) events_.message(line);
    };
    SharedScene<T> scene_;
    std::optional<CrewMaker<T>> maker_;
    Film<T> film_{0, 0};
    std::optional<PictureJournal<T>> journal_;
    PictureSize tile_{};
    RenderStats stats_;
};

template <typename T>
RenderedPicture render_in(const Scene& scene, const RenderSettings& settings,
                          const std::function<Devices()>& devices, const RenderEvents& events,
                          const StopFlag& stop, RenderCache& cache, ErrorControl& control) {
    Job<T> job(scene, settings, events, stop, cache, control);
    const Stopwatch watch;
    const Devices chosen = devices();
    return job.run(chosen, watch.seconds());
}

}  // namespace

RenderedPicture render_picture(const Scene& scene, RenderSettings settings,
                               const std::function<Devices()>& devices, const RenderEvents& events,
                               const StopFlag& stop, RenderCache* cache) {
    const auto render_once =
        settings.precision == Precision::float64 ? render_in<double> : render_in<float>;
    ErrorControl control;
    RenderCache own;
    if (cache == nullptr) cache = &own;
    if (settings.target_rmse <= 0) {
        return render_once(scene, settings, devices, events, stop, *cache, control);
    }
    settings.estimate = true;
    settings.kernels.any_samples = true;  // the same programs for both pictures
    Devices chosen;
    const auto choose = [&] { return chosen = devices(); };
    RenderedPicture first = render_once(scene, settings, choose, events, stop, *cache, control);
    if (!control.finer || stop != 0) return first;
    if (events.message) {
        events.message(fmt::format("{} with {}; rendering again with {}",
                                   to_string(*first.stats.estimate), to_string(scene.aa),
                                   to_string(*control.finer)));
    }
    leave_out_failed(chosen, first.stats);
    Scene finer = scene;
    finer.aa = *control.finer;
    const auto same = [&] { return chosen; };
    RenderedPicture second = render_once(finer, settings, same, events, stop, *cache, control);
    if (!second.stats.complete()) return first;
    if (auto& estimate = second.stats.estimate) estimate->seconds += first.stats.estimate->seconds;
    if (const std::string& failed = first.stats.device.fallback_from; !failed.empty()) {
        second.stats.note_failed(failed, first.stats.failure());
    }
    return second;
}

void leave_out_failed(std::vector<DeviceChoice>& devices, const RenderStats& stats) {
    if (!stats.device.fallback_from.empty() && has_opencl(devices)) devices = {threads_choice()};
}

}  // namespace rt
