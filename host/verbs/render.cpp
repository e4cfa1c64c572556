// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "host/console.h"
#include "host/error.h"
#include "host/image/image_error.h"
#include "host/image/output_path.h"
#include "host/image/picture_io.h"
#include "host/render/stopwatch.h"
#include "host/stop_signal.h"
#include "host/verbs/render_batch.h"
#include "host/verbs/render_steps.h"
#include "host/verbs/verbs.h"

namespace rt {

namespace {

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

int render_scene(RenderOptions options, double seconds_before_main) {
    const Stopwatch total;
    check_output(options);
    check_output_is_no_input(options.output, {options.scene, options.reference});
    choose_journal(options);
    auto devices = find_devices(options.device, options.threads, restore_stop_signals);
    Stopwatch watch;
    const Scene scene = scene_to_render(options);
    const double load_seconds = watch.lap();
    const std::optional<Picture> reference = load_reference(options, scene);
    const double reference_seconds = watch.lap();
    say_unsaved(options);
    const RenderConsole console(options);
    RenderedPicture rendered =
        render_picture(scene, options, std::move(devices), console.events(), stop_flag());
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

}  // namespace

int run_render(const RenderOptions& options, double seconds_before_main) {
    if (options.is_batch()) return render_batch(options);
    return render_scene(options, seconds_before_main);
}

}  // namespace rt
