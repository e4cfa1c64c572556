// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/render_steps.h"

#include <fmt/format.h>

#include <utility>

#include "host/console.h"
#include "host/error.h"
#include "host/image/image_error.h"
#include "host/image/output_path.h"
#include "host/image/picture_io.h"
#include "host/print/stats_json.h"
#include "host/print/stats_text.h"
#include "host/scene/scene_file.h"
#include "host/stop_signal.h"
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

}  // namespace

Scene scene_to_render(const RenderOptions& options) {
    Scene scene = load_scene(options.scene, options.light);
    check_output_is_no_input(options.output, scene.model_files);
    if (!options.quiet) print_notes(scene.notes);
    apply_overrides(scene, options);
    return scene;
}

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

RenderConsole::RenderConsole(const RenderOptions& options) {
    events_.message = [&options](const std::string& text) {
        const std::string line = options.verbose ? text : text.substr(0, text.find('\n'));
        if (!options.quiet) print_message("mirrorball: " + line + "\n");
    };
    if (options.verbose) events_.detail = events_.message;
    events_.started = [this, &options](const TileQueue& queue) {
        install_stop_signals();
        progress_.emplace(queue, progress_mode_for_stderr(options));
    };
    events_.ended = [this] { progress_.reset(); };
    events_.driver_loaded = restore_stop_signals;
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

}  // namespace rt
