// SPDX-License-Identifier: Apache-2.0
#include "host/cli/render_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/text.h"
#include "host/base/version.h"
#include "host/image/image_error.h"
#include "host/image/output_path.h"
#include "host/image/picture_io.h"
#include "host/journal/journal_file.h"
#include "host/print/print_stats.h"
#include "host/process/drivers.h"
#include "host/process/stop_signal.h"
#include "host/scene/scene_file.h"
#include "host/view/viewer.h"

namespace rt {

namespace {

/// The metadata of an unfinished picture (PNG and EXR have them); empty for any other file, which
/// may be somebody's.
PictureMetadata metadata_of_partial(const std::string& path) try {
    PictureMetadata metadata = read_picture_header(path).metadata;
    return text_in(metadata, partial_mark).empty() ? PictureMetadata() : metadata;
} catch (const Error&) {
    return {};
}

/// Where a picture's finished part goes: over an older part at most.
std::string free_partial_path(const std::string& output) {
    std::string path = partial_path(output);
    std::error_code ignored;
    for (int n = 2; std::filesystem::exists(path, ignored) && metadata_of_partial(path).empty();) {
        path = partial_path(output, n++);
    }
    return path;
}

/// Removes what an interrupted render of the same picture left next to it.
void remove_partial(const std::string& output, const PictureMetadata& metadata) {
    if (output == stdout_path) return;
    const std::string path = free_partial_path(output);
    const PictureMetadata partial = metadata_of_partial(path);
    std::error_code ignored;
    if (!partial.empty() && shows_the_same(partial, metadata)) {
        std::filesystem::remove(path, ignored);
    }
}

/// How much of a stopped picture is done.
std::string share_done(const RenderStats& stats) {
    return fmt::format("{} of {} tiles", stats.tiles_finished, stats.tiles);
}

}  // namespace

PictureMetadata picture_metadata(const std::string& scene, const std::string& scene_hash,
                                 const std::string& settings, const std::string& image_hash) {
    return {{"mirrorball:Scene", scene},
            {"mirrorball:SceneHash", scene_hash},
            {"mirrorball:Settings", settings},
            {"mirrorball:ImageHash", image_hash},
            {"mirrorball:Version", version}};
}

std::string text_in(const PictureMetadata& metadata, const std::string& name) {
    for (const auto& [key, text] : metadata) {
        if (key == name) return text;
    }
    return "";
}

bool shows_the_same(const PictureMetadata& a, const PictureMetadata& b) {
    for (const char* name : {"mirrorball:SceneHash", "mirrorball:Settings"}) {
        if (text_in(a, name) != text_in(b, name)) return false;
    }
    return true;
}

bool say_unsaved(const RenderOptions& options) {
    const bool wants_figures =
        options.stats != StatsFormat::summary || !options.reference.empty() || options.quiet;
    if (wants_figures || !options.output.empty()) return false;
    print_note("the picture is not saved; to save it, use -o FILE");
    return true;
}

bool report_non_finite(const Picture& picture, const Rect& region, std::size_t count) {
    if (count == 0) return false;
    const auto [x, y] = first_non_finite(picture);
    print_note(
        fmt::format("{} not finite, the first at {},{}; look for very large numbers in the scene",
                    counted(count, "pixel is", "pixels are"), region.x + x, region.y + y));
    return true;
}

void start_timeout(const RenderOptions& options) {
    if (options.timeout > 0) stop_after(std::max(options.timeout - seconds_before_worker(), 0.001));
}

std::future<std::vector<DeviceChoice>> start_finding_devices(const RenderOptions& options) {
    watch_worker(listing_devices);
    return find_devices(options.device, options.threads, [] {
        restore_stop_signals();
        watch_worker("");
    });
}

void check_output(const RenderOptions& options) {
    if (options.output.empty()) return;
    if (options.shares) return check_output_path(options.output);
    check_picture_path(options.output, options.format);
}

void choose_journal(RenderOptions& options) {
    if (options.output.empty() || options.target_rmse > 0) return;
    std::error_code ignored;
    if (options.scene != stdin_scene) {
        options.scene_file = std::filesystem::absolute(options.scene, ignored).string();
    }
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

Scene scene_to_render(const RenderOptions& options) {
    Scene scene = load_scene(options.scene, options.light);
    check_output_is_no_input(options.output, scene.model_files);
    apply_overrides(scene, options);
    if (!options.quiet) {
        print_notes(scene.notes);
        print_warnings(options.scene, scene_warnings(scene));
    }
    if (!options.output.empty() && !options.shares) {
        const Rect region = options.crop.value_or(Rect{0, 0, scene.width, scene.height});
        check_picture_fits(options.output, region.width, region.height, options.format);
    }
    return scene;
}

std::string save_picture(const RenderedPicture& rendered, const RenderOptions& options) {
    if (options.output.empty() || options.shares) return options.output;
    const RenderStats& stats = rendered.stats;
    PictureMetadata metadata =
        picture_metadata(stats.scene.name, hash_text(stats.scene.hash), to_string(stats.picture),
                         hash_text(stats.image_hash));
    if (stats.estimate) {
        metadata.push_back({"mirrorball:EstimatedError", to_string(*stats.estimate)});
    }
    if (!stats.device.fallback_from.empty()) {
        metadata.push_back({"mirrorball:FallbackFrom", stats.device.fallback_from});
        const std::string failure = stats.failure();
        if (!failure.empty()) metadata.push_back({"mirrorball:FallbackReason", failure});
    }
    std::string path = options.output;
    if (!stats.complete()) {
        if (stats.tiles_finished == 0 && stats.resumed == 0) return "";
        if (path == stdout_path) return "";  // a reader of stdout wants a whole picture
        path = free_partial_path(path);
        metadata.emplace_back(partial_mark, share_done(stats));
    }
    const StopsAtOnce may_wait_for_a_reader(find_output_destination(path).in_place);
    const auto write = [&] {
        write_picture(path, rendered.picture, options.encoding, metadata, options.format);
    };
    try {
        write();
    } catch (const DiskFull&) {
        if (!stats.complete() || !rendered.journal || !rendered.journal->exists()) throw;
        print_note(
            fmt::format("the disk is full; replacing {} with {}", rendered.journal->path(), path));
        rendered.journal->make_room(write);
    }
    if (!stats.complete()) return path;
    if (rendered.journal) rendered.journal->remove();
    remove_partial(options.output, metadata);
    return path;
}

std::function<void(const std::string& line)> message_printer(const RenderOptions& options) {
    return [&options](const std::string& text) {
        if (!options.quiet) print_note(options.verbose ? text : first_line(text));
    };
}

std::unique_ptr<LivePicture> make_live_picture(const RenderOptions& options) {
    const std::string name = options.output.empty() ? options.scene : options.output;
    auto viewers = make_viewers(options.view, name, options.encoding, message_printer(options));
    return viewers.empty() ? nullptr : std::make_unique<LivePicture>(std::move(viewers));
}

void wait_for_viewers(LivePicture& live) {
    const bool before = stop_quietly(true);
    live.wait([] { return stop_flag() != 0; });
    stop_quietly(before);
}

RenderConsole::RenderConsole(const RenderOptions& options, LivePicture* live) {
    events_.message = message_printer(options);
    if (options.verbose) events_.detail = events_.message;
    const ProgressMode progress = progress_mode_for_stderr(options);
    if (progress == ProgressMode::bar) events_.compiling = events_.message;
    if (live != nullptr) {
        events_.began = [live](int width, int height) { live->begin(width, height); };
        events_.rendered = [live](const Rect& part, std::vector<float> rgb) {
            live->put(part, std::move(rgb));
        };
    }
    const bool has_bar = !options.view.preview || options.progress != ProgressMode::automatic;
    events_.opening = [] { watch_worker("rendering"); };
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

RenderConsole::~RenderConsole() { watch_worker(""); }

void note_failed_device(RenderStats& stats, const RenderOptions& options) {
    if (options.failed_device.empty()) return;
    stats.note_failed(options.failed_device, options.device_failure);
}

void print_results(const RenderStats& stats, const RenderOptions& options) {
    if (options.stats == StatsFormat::json) return print_result(json_text(stats_json(stats)));
    if (options.stats == StatsFormat::text) return print_result(stats_text(stats));
    if (!options.quiet && stats.driver_took_its_time()) {
        print_note(driver_time_text(stats));
    }
    if (!options.quiet) print_message(summary_line(stats) + "\n");
    if (stats.error) print_result(error_line(*stats.error) + "\n");
}

int verdict(const RenderedPicture& rendered, const RenderOptions& options,
            const std::string& output) {
    const RenderStats& stats = rendered.stats;
    const bool non_finite =
        report_non_finite(rendered.picture, stats.picture.region, stats.non_finite);
    if (!stats.complete()) {
        const bool can_go_on = rendered.journal != nullptr && rendered.journal->exists() &&
                               rendered.journal->failure().empty();
        print_note(fmt::format("{} after {}{}{}", stop_reason(), share_done(stats),
                               output.empty() ? "" : "; the finished part is in " + output,
                               can_go_on ? "; the same command resumes from there" : ""));
        return exit_code_of_stop(stop_flag());
    }
    if (!stats.estimate && (options.estimate || options.target_rmse > 0)) {
        print_note(stop_reason() + " before the picture's error was estimated");
        return exit_code_of_stop(stop_flag());
    }
    if (stats.estimate && stats.estimate->target > 0 &&
        !stats.estimate->reaches(stats.estimate->target)) {
        print_note(fmt::format("{} with {}, not the target of {:g}: {}", to_string(*stats.estimate),
                               to_string(stats.picture.aa), stats.estimate->target,
                               stop_flag() != 0 ? stop_reason() : "no mode has more samples"));
        return stop_flag() != 0 ? exit_code_of_stop(stop_flag())
                                : static_cast<int>(ExitCode::incomplete);
    }
    return static_cast<int>(non_finite ? ExitCode::non_finite : ExitCode::done);
}

}  // namespace rt
