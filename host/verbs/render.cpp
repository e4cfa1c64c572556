// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "host/error.h"
#include "host/image/oiio_loader.h"
#include "host/image/picture_io.h"
#include "host/render/stopwatch.h"
#include "host/report/image_error.h"
#include "host/report/stats_json.h"
#include "host/report/stats_text.h"
#include "host/scene/json_file.h"
#include "host/stop_signal.h"
#include "host/verbs/picture_job.h"
#include "host/verbs/verbs.h"
#include "host/version.h"

namespace rt {

namespace {

/// What belongs to the picture, and nothing that changes from run to run or device to device.
PictureMetadata picture_metadata(const RenderStats& stats) {
    return {{"mirrorball:Scene", stats.scene.name},
            {"mirrorball:SceneHash", hash_text(stats.scene.hash)},
            {"mirrorball:Settings",
             fmt::format("{}x{}+{}+{} of {}x{}, {}, {} bounces, {}, {} math", stats.region.width,
                         stats.region.height, stats.region.x, stats.region.y, stats.width,
                         stats.height, to_string(stats.aa), stats.max_bounces,
                         stats.double_precision ? "double" : "float",
                         stats.fast_math ? "fast" : "strict")},
            {"mirrorball:ImageHash", hash_text(stats.image_hash)},
            {"mirrorball:Version", version}};
}

bool is_pfm(const std::string& path) {
    return path.size() >= 4 && (path.ends_with(".pfm") || path.ends_with(".PFM"));
}

void print_results(const RenderStats& stats, const RenderOptions& options) {
    if (options.stats == StatsFormat::json) {
        fmt::print("{}\n", stats_json(stats).dump(2));
    } else if (options.stats == StatsFormat::text) {
        fmt::print("{}", stats_text(stats));
    } else if (!options.quiet) {
        fmt::print(stderr, "{}\n", summary_line(stats));
        if (stats.error) fmt::print("{}\n", error_line(*stats.error));
    }
}

std::string first_non_finite(const Picture& picture) {
    std::size_t i = 0;
    while (i < picture.pixels.size() && std::isfinite(picture.pixels[i])) ++i;
    const std::size_t pixel = i / static_cast<std::size_t>(picture.channels);
    const auto width = static_cast<std::size_t>(picture.width);
    return fmt::format("{},{}", pixel % width, pixel / width);
}

/// What is wrong with a picture that was rendered, on stderr; and the exit status it means.
int verdict(const RenderedPicture& rendered, const std::string& output) {
    const RenderStats& stats = rendered.stats;
    if (stats.non_finite > 0) {
        fmt::print(stderr,
                   "mirrorball: {} pixels are not finite, the first at {}; look at the scene's "
                   "largest numbers there\n",
                   stats.non_finite, first_non_finite(rendered.picture));
        return static_cast<int>(ExitCode::non_finite);
    }
    if (!stats.complete()) {
        fmt::print(stderr, "mirrorball: stopped by signal {} after {} of {} tiles{}\n",
                   static_cast<int>(stop_flag()), stats.tiles_finished, stats.tiles,
                   output.empty() ? "" : "; what was finished is in " + output);
        return 128 + static_cast<int>(stop_flag());
    }
    return static_cast<int>(ExitCode::done);
}

}  // namespace

int run_render(const RenderOptions& options, double seconds_before_main) {
    const Stopwatch total;
    if (!options.output.empty()) {
        check_picture_path(options.output);
        if (!is_pfm(options.output)) preload_image_library();
    }
    Stopwatch watch;
    Scene scene = load_json_scene(options.scene);
    apply_overrides(scene, options);
    const double load_seconds = watch.seconds();
    RenderedPicture rendered = render_picture(scene, options);
    RenderStats& stats = rendered.stats;
    stats.scene.path = options.scene;
    stats.phases.start = seconds_before_main;
    stats.phases.load = load_seconds;
    watch.lap();
    if (!options.output.empty()) {
        write_picture(options.output, rendered.picture, options.encoding, picture_metadata(stats));
    }
    stats.phases.write = watch.seconds();
    stats.phases.total = seconds_before_main + total.seconds();
    if (!options.reference.empty()) {
        stats.error = image_error(rendered.picture, read_picture(options.reference));
    }
    print_results(stats, options);
    return verdict(rendered, options.output);
}

}  // namespace rt
