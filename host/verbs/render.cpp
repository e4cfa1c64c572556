// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <future>
#include <optional>
#include <string>
#include <utility>

#include "host/console.h"
#include "host/error.h"
#include "host/image/image_error.h"
#include "host/image/output_path.h"
#include "host/image/picture_io.h"
#include "host/picture/render_picture.h"
#include "host/print/stats_json.h"
#include "host/print/stats_text.h"
#include "host/render/stopwatch.h"
#include "host/scene/scene_file.h"
#include "host/stop_signal.h"
#include "host/verbs/progress.h"
#include "host/verbs/verbs.h"
#include "host/version.h"

namespace rt {

namespace {

/// What belongs to the picture, and nothing that changes from run to run or device to device, but
/// that a device failed.
PictureMetadata picture_metadata(const RenderStats& stats) {
    PictureMetadata metadata{
        {"mirrorball:Scene", stats.scene.name},
        {"mirrorball:SceneHash", hash_text(stats.scene.hash)},
        {"mirrorball:Settings",
         fmt::format("{}x{}+{}+{} of {}x{}, {}, {} filter, {} bounces, {}, {} math",
                     stats.region.width, stats.region.height, stats.region.x, stats.region.y,
                     stats.width, stats.height, to_string(stats.aa), to_string(stats.filter),
                     stats.max_bounces, stats.double_precision ? "double" : "float",
                     stats.fast_math ? "fast" : "strict")},
        {"mirrorball:ImageHash", hash_text(stats.image_hash)},
        {"mirrorball:Version", version}};
    if (!stats.device.fallback_from.empty()) {
        metadata.push_back({"mirrorball:FallbackFrom", stats.device.fallback_from});
    }
    return metadata;
}

void print_results(const RenderStats& stats, const RenderOptions& options) {
    if (options.stats == StatsFormat::json) return print_result(json_text(stats_json(stats)));
    if (options.stats == StatsFormat::text) return print_result(stats_text(stats));
    if (!options.quiet && stats.driver_took_its_time()) {
        print_message("mirrorball: " + driver_time_text(stats) + "\n");
    }
    if (!options.quiet) print_message(summary_line(stats) + "\n");
    if (stats.error) print_result(error_line(*stats.error) + "\n");
}

/// Says what is wrong with the values of a picture; whether anything is.
bool report_non_finite(const RenderedPicture& rendered) {
    const std::size_t count = rendered.stats.non_finite;
    if (count == 0) return false;
    const auto [x, y] = first_non_finite(rendered.picture);
    print_message(
        fmt::format("mirrorball: {} pixel{} not finite, the first at {},{}; look for "
                    "very large numbers in the scene\n",
                    count, count == 1 ? " is" : "s are", rendered.stats.region.x + x,
                    rendered.stats.region.y + y));
    return true;
}

/// What there is of a picture that was stopped.
std::string share_done(const RenderStats& stats) {
    return fmt::format("{} of {} tiles{}", stats.tiles_finished, stats.tiles,
                       stats.tiles_finished == stats.tiles ? ", not all refined" : "");
}

/// What is wrong with a picture that was rendered, on stderr; and the exit status it means.
int verdict(const RenderedPicture& rendered, const std::string& output) {
    const RenderStats& stats = rendered.stats;
    const bool non_finite = report_non_finite(rendered);
    if (!stats.complete()) {
        print_message(fmt::format("mirrorball: {} after {}{}\n", stop_reason(), share_done(stats),
                                  output.empty() ? "" : "; what was finished is in " + output));
        return 128 + stop_flag();
    }
    return static_cast<int>(non_finite ? ExitCode::non_finite : ExitCode::done);
}

/// The picture to compare with, read before it may be overwritten and before hours are spent.
std::optional<Picture> load_reference(const RenderOptions& options, const Scene& scene) {
    if (options.reference.empty()) return std::nullopt;
    Picture reference = read_picture(options.reference);
    const int width = options.crop ? options.crop->width : scene.width;
    const int height = options.crop ? options.crop->height : scene.height;
    if (reference.width == width && reference.height == height && reference.channels == 3) {
        return reference;
    }
    throw Error(ExitCode::input,
                fmt::format("{}: {}x{} pixels of {} channels, and the picture will be {}x{} of 3; "
                            "give --size or --crop to match",
                            options.reference, reference.width, reference.height,
                            reference.channels, width, height));
}

/// Who asks for figures alone wants no picture.
void say_unsaved(const RenderOptions& options) {
    const bool wants_figures =
        options.stats != StatsFormat::summary || !options.reference.empty() || options.quiet;
    if (wants_figures || !options.output.empty()) return;
    print_message("mirrorball: without -o FILE the picture is not saved\n");
}

/// Writes the picture, an unfinished one next to where it belongs: what is there may be finished.
/// Returns the name it got.
std::string save_picture(const RenderedPicture& rendered, const RenderOptions& options) {
    if (options.output.empty()) return "";
    const RenderStats& stats = rendered.stats;
    PictureMetadata metadata = picture_metadata(stats);
    std::string path = options.output;
    if (!stats.complete()) {
        path = partial_path(path);
        metadata.emplace_back("mirrorball:Partial", share_done(stats));
    }
    write_picture(path, rendered.picture, options.encoding, metadata);
    return path;
}

RenderedPicture render_with_progress(const Scene& scene, const RenderOptions& options,
                                     std::future<std::vector<DeviceChoice>> devices) {
    std::optional<ProgressReporter> progress;
    RenderEvents events;
    events.message = [&](const std::string& text) {
        const std::string line = options.verbose ? text : text.substr(0, text.find('\n'));
        if (!options.quiet) print_message("mirrorball: " + line + "\n");
    };
    if (options.verbose) events.detail = events.message;
    events.started = [&](const TileQueue& queue) {
        install_stop_signals();
        progress.emplace(queue, progress_mode_for_stderr(options));
    };
    events.ended = [&] { progress.reset(); };
    events.driver_loaded = restore_stop_signals;
    return render_picture(scene, options, std::move(devices), events, stop_flag());
}

}  // namespace

int run_render(const RenderOptions& options, double seconds_before_main) {
    const Stopwatch total;
    if (!options.output.empty()) {
        check_picture_path(options.output);
        check_output_is_no_input(options.output, {options.scene, options.reference});
    }
    auto devices = find_devices(options.device, options.threads, restore_stop_signals);
    Stopwatch watch;
    Scene scene = load_scene(options.scene, options.light);
    if (!options.quiet) print_notes(scene.notes);
    apply_overrides(scene, options);
    const double load_seconds = watch.lap();
    const std::optional<Picture> reference = load_reference(options, scene);
    const double reference_seconds = watch.lap();
    say_unsaved(options);
    RenderedPicture rendered = render_with_progress(scene, options, std::move(devices));
    RenderStats& stats = rendered.stats;
    stats.scene.path = options.scene;
    stats.phases.start = seconds_before_main;
    stats.phases.load = load_seconds;
    watch.lap();
    const std::string path = save_picture(rendered, options);
    stats.phases.write = watch.seconds();
    stats.phases.total = seconds_before_main + total.seconds() - reference_seconds;
    if (reference) stats.error = image_error(rendered.picture, *reference);
    print_results(stats, options);
    return verdict(rendered, path);
}

}  // namespace rt
