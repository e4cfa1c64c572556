// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/console.h"
#include "host/error.h"
#include "host/image/image_error.h"
#include "host/image/output_path.h"
#include "host/image/picture_io.h"
#include "host/opencl/icd_files.h"
#include "host/render/stopwatch.h"
#include "host/stop_signal.h"
#include "host/temporary_folder.h"
#include "host/verbs/render_batch.h"
#include "host/verbs/render_steps.h"
#include "host/verbs/verbs.h"
#include "host/worker.h"

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
    watch_worker(true);
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
    watch_worker(false);
    RenderStats& stats = rendered.stats;
    if (!options.failed_device.empty()) stats.device.fallback_from = options.failed_device;
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

/// By workers, which load the drivers. When the first one crashes another tries again, without
/// drivers that do so when they list their devices, and with an empty kernel cache. Then, or when
/// it hangs, threads go on here with what the journal has.
int render_isolated(RenderOptions options, double seconds_before_main) {
    const Stopwatch watch;
    const auto work = [&](const std::vector<std::string>& changes) {
        return run_worker(options.command, changes, options.deadline,
                          seconds_before_main + watch.seconds());
    };
    const std::string name = options.device.empty() ? "OpenCL" : "--device " + options.device;
    const auto say = [&](const WorkerEnd& end, const char* then) {
        if (options.quiet) return;
        print_message(
            fmt::format("mirrorball: {}: the process of its driver {}; {}\n", name, end.how, then));
    };
    WorkerEnd end = work({});
    if (!end.is_regular && !end.is_hung) {
        const IcdFiles files = try_icd_files(options.drivers);
        if (!files.any_dangerous) {
            const TemporaryFolder cache;
            say(end, "trying once more with an empty kernel cache");
            end = work({"POCL_CACHE_DIR=" + cache.name()});
        } else if (!files.usable.empty()) {
            const UsableIcdFiles usable(files);
            say(end, "trying once more with the other drivers");
            const WorkerEnd second = work({"OCL_ICD_VENDORS=" + usable.place()});
            const bool lacks_device =
                second.is_regular && second.status == static_cast<int>(ExitCode::device);
            if (!lacks_device) end = second;
        }
    }
    if (end.is_regular) return end.status;
    if (options.no_fallback) {
        throw Error(ExitCode::device, name + ": the process of its driver " + end.how);
    }
    say(end, "rendering on threads instead");
    options.failed_device = name;
    options.device = "threads";
    return render_scene(std::move(options), seconds_before_main + watch.seconds());
}

}  // namespace

int run_render(const RenderOptions& options, double seconds_before_main) {
    if (options.is_batch()) return render_batch(options);
    if (options.isolate && !is_worker() && needs_opencl(options.device)) {
        return render_isolated(options, seconds_before_main);
    }
    return render_scene(options, seconds_before_main);
}

}  // namespace rt
