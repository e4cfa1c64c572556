// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/text.h"
#include "host/cli/batch_list.h"
#include "host/cli/render_steps.h"
#include "host/image/image_error.h"
#include "host/image/output_path.h"
#include "host/image/picture_io.h"
#include "host/process/drivers.h"
#include "host/process/stop_signal.h"
#include "host/render/stopwatch.h"
#include "host/scene/scene_file.h"
#include "host/scene/text_file.h"

namespace rt {

namespace {

/// The reference picture, read before the render takes hours and perhaps overwrites it.
std::optional<Picture> load_reference(const RenderOptions& options, const Scene& scene) {
    if (options.reference.empty()) return std::nullopt;
    Picture reference = read_picture(options.reference);
    const int width = options.crop ? options.crop->width : scene.width;
    const int height = options.crop ? options.crop->height : scene.height;
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

/// `kept`: viewers that stay open for the next picture; null: they wait to be closed.
int render_scene(RenderOptions options, double seconds_before_main, LivePicture* kept) {
    const Stopwatch total;
    start_timeout(options);
    check_output(options);
    const std::vector<std::string> inputs{options.scene, options.reference};
    check_output_is_no_input(options.output, inputs);
    check_aov_files(options, inputs);
    choose_journal(options);
    auto devices = start_finding_devices(options);
    Stopwatch watch;
    const Scene scene = scene_to_render(options);
    check_aov_files(options, scene.model_files);
    const double load_seconds = watch.lap();
    const std::optional<Picture> reference = load_reference(options, scene);
    const double reference_seconds = watch.lap();
    say_unsaved(options);
    const auto own = kept == nullptr ? make_live_picture(options) : nullptr;
    LivePicture* const live = kept == nullptr ? own.get() : kept;
    RenderConsole console(options, live);
    RenderedPicture rendered =
        render_picture(scene, options, std::move(devices), console.events(), stop_flag());
    RenderStats& stats = rendered.stats;
    note_failed_device(stats, options);
    stats.scene.path = options.scene;
    stats.phases.start = seconds_before_main;
    stats.phases.load = load_seconds;
    watch.lap();
    const std::string path = save_picture(rendered, options);
    stats.phases.write = watch.seconds();
    stats.phases.total = seconds_before_main + total.seconds() - reference_seconds;
    if (live != nullptr) live->finish(rendered.picture);
    const auto pixels =
        static_cast<std::size_t>(stats.picture.region.width) * stats.picture.region.height;
    if (reference && stats.non_finite < pixels) {
        stats.error = image_error(rendered.picture, *reference);
    }
    print_results(stats, options);
    const bool has_aovs = write_aovs(scene, stats, options);
    int status = has_aovs ? verdict(rendered, options, path) : exit_code_of_stop(stop_flag());
    if (status == 0 && options.expected_hash.value_or(stats.image_hash) != stats.image_hash) {
        print_note(fmt::format("the picture's hash is {}, expected {}", hash_text(stats.image_hash),
                               hash_text(*options.expected_hash)));
        status = static_cast<int>(ExitCode::different);
    }
    if (own) wait_for_viewers(*own);
    return status;
}

/// Renders again and again, in the same viewers, until the window is closed.
int render_and_watch(const RenderOptions& options, double seconds_before_main) {
    const auto live = make_live_picture(options);
    const auto render = [&] {
        return render_scene(options, std::exchange(seconds_before_main, 0.0), live.get());
    };
    const auto is_over = [&] { return options.view.window && live->is_over(); };
    return watch_scene(options.scene, options.quiet, render, is_over);
}

int render_here(const RenderOptions& options, double seconds_before_main) {
    if (options.is_batch()) return render_batch(options);
    if (options.watch) return render_and_watch(options, seconds_before_main);
    return render_scene(options, seconds_before_main, nullptr);
}

/// When the picture's journal was last written; the epoch if there is none.
std::filesystem::file_time_type journal_time(RenderOptions options) {
    choose_journal(options);
    std::error_code ignored;
    return std::filesystem::last_write_time(options.journal, ignored);
}

/// A worker gets extra time to save its picture at --timeout: its driver may never finish.
WorkerCommand worker_command(const RenderOptions& options, double seconds_before_main) {
    WorkerCommand command{options.command, {}, options.deadline, seconds_before_main};
    if (options.timeout > 0) command.longest = options.timeout + options.deadline;
    return command;
}

/// Renders in a worker process, which loads the OpenCL drivers; if that fails, threads finish the
/// picture or batch in this one.
int render_isolated(RenderOptions options, double seconds_before_main) {
    const Stopwatch watch;
    const std::string name = options.device.empty() ? "OpenCL" : "--device " + options.device;
    if (options.scene == stdin_scene) keep_stdin();  // the worker reads it
    const auto journal_before = journal_time(options);
    const WorkerEnd end = run_without_bad_drivers(worker_command(options, seconds_before_main),
                                                  options.drivers, options.quiet);
    if (end.is_regular) return end.status;
    const std::string failure = "the driver process " + end.how;
    if (options.no_fallback) throw Error(ExitCode::device, name + ": " + failure);
    if (!options.quiet) print_note(name + ": " + failure + "; rendering on threads instead");
    // What the worker has written with --fresh is resumed.
    if (journal_time(options) != journal_before) options.fresh = false;
    if (options.timeout > 0) options.timeout = std::max(options.timeout - watch.seconds(), 0.001);
    options.batch_past = end.records;
    options.failed_device = name;
    options.device_failure = failure;
    options.device = "threads";
    return render_here(options, seconds_before_main + watch.seconds());
}

}  // namespace

int run_render(const RenderOptions& options, double seconds_before_main) {
    if (options.isolate && !is_worker() && needs_opencl(options.device)) {
        return render_isolated(options, seconds_before_main);
    }
    return render_here(options, seconds_before_main);
}

}  // namespace rt
