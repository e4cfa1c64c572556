// SPDX-License-Identifier: Apache-2.0
#include "host/cli/render_pictures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <optional>
#include <sstream>
#include <thread>
#include <utility>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/parallel.h"
#include "host/base/text.h"
#include "host/cli/progress.h"
#include "host/image/image_error.h"
#include "host/image/picture_io.h"
#include "host/opencl/devices.h"
#include "host/picture/crew.h"
#include "host/print/print_stats.h"
#include "host/process/drivers.h"
#include "host/process/stop_signal.h"
#include "host/scene/scene.h"
#include "host/scene/scene_file.h"

namespace rt {

namespace {

/// The reference picture, read before the render takes hours and perhaps overwrites it.
std::optional<Picture> load_reference(const RenderOptions& options, const Scene& scene) {
    if (options.reference.empty()) return std::nullopt;
    Picture reference = read_picture(options.reference);
    const auto [left, top, width, height] = picture_spec(scene, options).region;
    if (reference.width == width && reference.height == height && reference.channels == 3) {
        if (const std::size_t count = count_non_finite(reference); count > 0) {
            const auto [x, y] = first_non_finite(reference);
            throw Error(
                ExitCode::input,
                fmt::format("{}: {} not finite, the first at {},{}; use a reference "
                            "without NaN and infinities",
                            options.reference, counted(count, "pixel is", "pixels are"), x, y));
        }
        return reference;
    }
    throw Error(ExitCode::input,
                fmt::format("{}: has {}x{} pixels and {}, but the picture will "
                            "have {}x{} and 3; adjust --size or --crop",
                            options.reference, reference.width, reference.height,
                            counted(reference.channels, "channel"), width, height));
}

/// Warns that the picture is not saved, unless only figures are wanted. Returns whether it did.
bool say_unsaved(const RenderOptions& options) {
    const bool wants_figures =
        options.stats != StatsFormat::summary || !options.reference.empty() || options.quiet;
    if (wants_figures || !options.output.empty()) return false;
    print_note("the picture is not saved; to save it, use -o FILE");
    return true;
}

/// Finds the devices on another thread, as find_devices; a worker's parent watches their drivers.
std::future<std::vector<DeviceChoice>> start_finding_devices(const RenderOptions& options) {
    watch_worker(listing_devices);
    return find_devices(options.device, options.threads, [] {
        restore_stop_signals();
        watch_worker("");
    });
}

/// Prints a render's messages on stderr: of each its first line, or all with --verbose; nothing
/// with --quiet. The options must outlive it.
std::function<void(const std::string& line)> message_printer(const RenderOptions& options) {
    return [&options](const std::string& text) {
        if (!options.quiet) print_note(options.verbose ? text : first_line(text));
    };
}

/// After the final picture: waits until the windows are closed and viewers have the picture, or for
/// a stop signal, which is not reported, since everything is done.
void wait_for_viewers(LivePicture& live) {
    const bool before = stop_quietly(true);
    while (!live.is_over() && stop_flag() == 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    stop_quietly(before);
}

/// Shows a render's events on stderr and in viewers, if there are any, and has a worker's parent
/// watch the drivers meanwhile. All must outlive it.
class RenderConsole {
   public:
    RenderConsole(const RenderOptions& options, LivePicture* live) {
        events_.message = message_printer(options);
        if (options.verbose) events_.detail = events_.message;
        const ProgressMode progress = progress_mode_for_stderr(options);
        if (live != nullptr) {
            events_.began = [live](int width, int height) { live->begin(width, height); };
            events_.rendered = [live](const Rect& part, std::vector<float> rgb) {
                live->put(part, std::move(rgb));
            };
        }
        const bool has_bar = !options.view.preview || options.progress != ProgressMode::automatic;
        events_.opening = [this, progress](const std::string& devices) {
            watch_worker("rendering");
            if (progress == ProgressMode::bar)
                events_.message(devices + ": opening, compiling new kernels");
        };
        events_.started = [this, progress, has_bar](const TileQueue& queue) {
            install_stop_signals();
            if (has_bar) progress_.emplace(queue, progress);
        };
        if (is_worker()) events_.progressed = note_worker_progress;
        events_.ended = [this] {
            watch_worker("");
            progress_.reset();
        };
        events_.driver_loaded = restore_stop_signals;
    }
    RenderConsole(const RenderConsole&) = delete;
    RenderConsole& operator=(const RenderConsole&) = delete;
    ~RenderConsole() { watch_worker(""); }

    const RenderEvents& events() const { return events_; }

   private:
    std::optional<ProgressReporter> progress_;
    RenderEvents events_;
};

/// What goes to stdout: the figures that options.stats requests; as JSON of a batch, one line per
/// picture.
std::string results_text(const RenderStats& stats, const RenderOptions& options) {
    if (options.stats == StatsFormat::json) {
        const Json json = stats_json(stats);
        return options.is_batch() ? json.dump() + "\n" : json_text(json);
    }
    if (options.stats == StatsFormat::text) return stats_text(stats);
    return stats.error ? error_line(*stats.error) + "\n" : "";
}

/// Renders a picture while the one before it is written.
class Pictures {
   public:
    Pictures(const RenderOptions& options, double seconds_before_main, LivePicture* kept)
        : options_(options), seconds_before_main_(seconds_before_main), kept_(kept) {
        if (is_batch_) devices_ = start_finding_devices(options).get();
        inputs_.add(options.batch);
        inputs_.add(options.reference);
        for (const BatchItem& item : options.items) inputs_.add(item.scene);
        for (const std::string& record : options.batch_past) {
            std::istringstream fields(record);
            std::size_t at = 0;
            int status = 0;
            fields >> at >> status;
            past_[at] = status;
        }
    }

    int run() {
        if (!options_.frames.empty()) {
            load_afresh(options_);
            if (scene_.path.keys.empty()) camera_at(scene_, 0);  // throws
        }
        // The first one reports a stop that comes early.
        for (std::size_t at = 0; at < options_.items.size() && (at == 0 || stop_flag() == 0);
             ++at) {
            if (const auto past = past_.find(at); past != past_.end()) {
                count(at, past->second);
            } else {
                attempt(at, [&] { start(at); });
            }
        }
        settle();
        return is_batch_ ? sum_up() : worst_;
    }

   private:
    /// Of a batch, errors are noted, unless results cannot be printed any more.
    template <typename Work>
    void attempt(std::size_t at, const Work& work) {
        if (!is_batch_) return work();
        try {
            work();
        } catch (const Error& error) {
            if (std::ferror(stdout) != 0) throw;
            note(at, error);
        } catch (const std::bad_alloc&) {
            note(at, Error(ExitCode::limit, out_of_memory));
        }
    }

    void start(std::size_t at) {
        const Stopwatch total;
        const BatchItem& item = options_.items[at];
        RenderOptions options = options_;
        options.scene = item.scene;
        options.output = item.output;
        if (item.frame && options.resume && std::filesystem::exists(options.output) &&
            may_show(options.output, load(item, options), options)) {
            ++there_;
            return;
        }
        check_outputs(options);
        choose_journal(options);
        if (!is_batch_) finding_ = start_finding_devices(options);
        Stopwatch watch;
        const Scene& scene = load(item, options);
        const double load_seconds = watch.lap();
        std::optional<Picture> reference = load_reference(options, scene);
        const double uncounted = watch.lap();
        if (!has_said_unsaved_) has_said_unsaved_ = say_unsaved(options);
        const auto own = kept_ == nullptr ? make_live_picture(options) : nullptr;
        LivePicture* const live = kept_ == nullptr ? own.get() : kept_;
        RenderConsole console(options, live);
        RenderedPicture rendered = render(scene, options, console.events());
        if (live != nullptr) live->finish(rendered.picture);
        RenderStats& stats = rendered.stats;
        if (!options.failed_device.empty()) {
            stats.note_failed(options.failed_device, options.device_failure);
        }
        stats.scene.path = options.scene;
        stats.phases.start = seconds_before_main_;
        stats.phases.load = load_seconds;
        settle();
        written_ = at;
        writing_ = std::async(
            [=, this, rendered = std::move(rendered), reference = std::move(reference)]() mutable {
                return finish(at, options, std::move(rendered), reference,
                              [&] { return seconds_before_main_ + total.seconds() - uncounted; });
            });
        if (own) wait_for_viewers(*own);
    }

    /// Rejects, before anything is computed, outputs that could not be written, or are inputs.
    void check_outputs(const RenderOptions& options) const {
        if (options.shares) {
            check_output_path(options.output);
        } else if (!options.output.empty()) {
            check_picture_path(options.output, options.format);
        }
        check_inputs(options);
    }

    /// Rejects outputs that are inputs.
    void check_inputs(const RenderOptions& options) const {
        inputs_.check(options.output);
        inputs_.check(partial_path(options.output));
        check_aov_files(options, inputs_);
    }

    /// The scene of all frames is loaded before the first.
    const Scene& load(const BatchItem& item, const RenderOptions& options) {
        if (item.frame) {
            scene_.camera = camera_at(scene_, *item.frame);
            set_image_size(scene_, scene_.width, scene_.height);
        } else {
            load_afresh(options);
        }
        return scene_;
    }

    /// Loads options.scene as it is to be rendered; reports on stderr what the reader skipped and
    /// what looks wrong in it. Rejects an output that is one of the files it names.
    void load_afresh(const RenderOptions& options) {
        scene_ = load_scene(options.scene, options.light);
        for (const std::string& file : scene_.model_files) inputs_.add(file);
        check_inputs(options);
        apply_overrides(scene_, options);
        const bool has_own = std::ranges::all_of(scene_.lights, &Scene::Light::has_own_intensity);
        if (!options.quiet) {
            if (options.light.light_scale && has_own)
                print_note(printable(options.scene) + ": --light-scale has no effect on it");
            print_notes(scene_.notes);
            print_warnings(options.scene, scene_warnings(scene_));
        }
        if (!options.output.empty() && !options.shares) {
            const Rect region = picture_spec(scene_, options).region;
            check_picture_fits(options.output, region.width, region.height, options.format);
        }
    }

    RenderedPicture render(const Scene& scene, const RenderOptions& options,
                           const RenderEvents& events) {
        const auto devices = [this] { return is_batch_ ? devices_ : finding_.get(); };
        RenderedPicture rendered =
            render_picture(scene, options, devices, events, stop_flag(), &cache_);
        leave_out_failed(devices_, rendered.stats);
        return rendered;
    }

    /// Writes a picture and reports how it went. Returns the exit status.
    int finish(std::size_t at, const RenderOptions& options, RenderedPicture rendered,
               const std::optional<Picture>& reference, const std::function<double()>& total) {
        const Stopwatch writing;
        const std::string path = save_picture(rendered, options);
        RenderStats& stats = rendered.stats;
        stats.phases.write = writing.seconds();
        stats.phases.total = total();
        const Rect& region = stats.picture.region;
        if (reference &&
            stats.non_finite < static_cast<std::size_t>(region.width) * region.height) {
            stats.error = image_error(rendered.picture, *reference);
        }
        std::vector<std::string> notes;
        int status = verdict(rendered, options, path, notes);
        const std::uint64_t expected = options.expected_hash.value_or(stats.image_hash);
        if (status == 0 && expected != stats.image_hash) {
            notes.push_back(fmt::format("the picture's hash is {}, expected {}",
                                        hash_text(stats.image_hash), hash_text(expected)));
            status = static_cast<int>(ExitCode::different);
        }
        if (options.stats == StatsFormat::summary && !options.quiet) {
            print_message(summary_line(stats) + "\n");
        }
        print_notes(notes);
        if (!options.aovs.empty()) scene_.aa = stats.picture.aa;  // which a target chooses
        if (!write_aovs(scene_, stats, options)) status = exit_code_of_stop(stop_flag());
        report(at, status, results_text(stats, options));
        return status;
    }

    /// Waits for the picture that is being written.
    void settle() {
        if (!writing_.valid()) return;
        attempt(written_, [&] { count(written_, writing_.get()); });
    }

    /// Prints a picture's results. A worker's parent does, since a driver may end the worker at any
    /// moment: so it knows exactly whose results are printed, and renders what is left.
    static void report(std::size_t at, int status, const std::string& results) {
        const std::string record = fmt::format("{} {}\n{}", at, status, results);
        if (is_worker()) return tell_parent(record);
        print_finished(record);
    }

    void note(std::size_t at, const Error& error) {
        const int status = static_cast<int>(error.exit_code());
        print_note(options_.items[at].where + error.what());
        report(at, status, "");
        count(at, status);
    }

    void count(std::size_t at, int status) {
        ++pictures_;
        if (status == 0) return;
        const BatchItem& item = options_.items[at];
        worst_ = std::max(worst_, status);
        failed_.push_back(item.frame ? fmt::format("frame {} ({})", *item.frame, status)
                                     : fmt::format("{} ({})", item.scene, status));
    }

    int sum_up() const {
        if (there_ > 0 && !options_.quiet) {
            print_note("skipped " + counted(there_, "existing frame"));
        }
        if (stop_flag() != 0) {
            print_note(fmt::format("{} after {}", stop_reason(), counted(pictures_, "picture")));
            return exit_code_of_stop(stop_flag());
        }
        if (failed_.empty()) return 0;
        print_note(fmt::format("{} of {} failed, with exit codes: {}", failed_.size(),
                               counted(pictures_, "picture"), fmt::join(failed_, ", ")));
        return worst_;
    }

    const RenderOptions& options_;
    const bool is_batch_ = options_.is_batch();
    const double seconds_before_main_;
    LivePicture* const kept_;
    std::map<std::size_t, int> past_;    ///< the statuses of pictures that a worker has finished
    std::vector<DeviceChoice> devices_;  ///< of a batch
    std::future<std::vector<DeviceChoice>> finding_;  ///< those of a single picture
    RenderCache cache_;
    UsedFiles inputs_;  ///< as far as they are known
    Scene scene_;
    bool has_said_unsaved_ = false;
    std::size_t there_ = 0;  ///< frames skipped since their pictures existed
    std::future<int> writing_;
    std::size_t written_ = 0;
    std::size_t pictures_ = 0;
    std::vector<std::string> failed_;
    int worst_ = 0;
};

}  // namespace

void print_finished(const std::string& record) {
    print_result(record.substr(record.find('\n') + 1));
    flush_results();
}

void choose_journal(RenderOptions& options) {
    if (options.output.empty() || options.target_rmse > 0) return;
    if (options.shares) {
        options.journal = options.output;
    } else if (!find_output_destination(options.output).in_place) {
        options.journal = options.output + ".mbj";
    }
}

void print_warnings(const std::string& scene, const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) {
        print_note(fmt::format("{}: warning: {}", printable(scene), warning));
    }
}

std::unique_ptr<LivePicture> make_live_picture(const RenderOptions& options) {
    const std::string name = options.output.empty() ? options.scene : options.output;
    auto viewers =
        make_viewers(options.view, name, options.encoding, message_printer(options), stop_flag());
    return viewers.empty() ? nullptr : std::make_unique<LivePicture>(std::move(viewers));
}

int render_pictures(const RenderOptions& options, double seconds_before_main, LivePicture* kept) {
    if (options.timeout > 0) stop_after(std::max(options.timeout - seconds_before_worker(), 0.001));
    return Pictures(options, seconds_before_main, kept).run();
}

}  // namespace rt
