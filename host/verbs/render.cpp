// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/console.h"
#include "host/error.h"
#include "host/image/image_error.h"
#include "host/image/output_path.h"
#include "host/image/picture_io.h"
#include "host/journal/journal_file.h"
#include "host/opencl/icd_files.h"
#include "host/render/stopwatch.h"
#include "host/scene/scene_file.h"
#include "host/scene/stdin_text.h"
#include "host/stop_signal.h"
#include "host/temporary_folder.h"
#include "host/verbs/aov.h"
#include "host/verbs/render_batch.h"
#include "host/verbs/render_mpi.h"
#include "host/verbs/render_steps.h"
#include "host/verbs/verbs.h"
#include "host/verbs/watch.h"
#include "host/worker.h"

namespace rt {

namespace {

/// The reference picture, read before the render takes hours and perhaps overwrites it.
std::optional<Picture> load_reference(const RenderOptions& options, const Scene& scene) {
    if (options.reference.empty()) return std::nullopt;
    Picture reference = read_picture(options.reference);
    const int width = options.crop ? options.crop->width : scene.width;
    const int height = options.crop ? options.crop->height : scene.height;
    if (reference.width == width && reference.height == height && reference.channels == 3) {
        return reference;
    }
    throw Error(ExitCode::input, fmt::format("{}: {}x{} pixels of {} channels, but the picture "
                                             "will be {}x{} of 3; give --size or --crop to match",
                                             options.reference, reference.width, reference.height,
                                             reference.channels, width, height));
}

/// Warns that the picture is not saved, unless only figures are wanted.
void say_unsaved(const RenderOptions& options) {
    const bool wants_figures =
        options.stats != StatsFormat::summary || !options.reference.empty() || options.quiet;
    if (wants_figures || !options.output.empty()) return;
    print_message("mirrorball: without -o FILE the picture is not saved\n");
}

int render_scene(RenderOptions options, double seconds_before_main) {
    const Stopwatch total;
    if (options.timeout > 0) stop_after(options.timeout);
    check_output(options);
    check_output_is_no_input(options.output, {options.scene, options.reference});
    check_aov_files(options);
    choose_journal(options);
    watch_worker(true);
    auto devices = find_devices(options.device, options.threads, restore_stop_signals);
    Stopwatch watch;
    const Scene scene = scene_to_render(options);
    const double load_seconds = watch.lap();
    const std::optional<Picture> reference = load_reference(options, scene);
    const double reference_seconds = watch.lap();
    say_unsaved(options);
    RenderConsole console(options);
    RenderedPicture rendered =
        render_picture(scene, options, std::move(devices), console.events(), stop_flag());
    watch_worker(false);
    console.finish(rendered.picture);
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
    const bool has_aovs = write_aovs(scene, stats, options);
    const int status = has_aovs ? verdict(rendered, path) : exit_code_of_stop(stop_flag());
    console.wait();
    return status;
}

/// Renders in worker processes, which load the drivers.
class IsolatedRender {
   public:
    IsolatedRender(RenderOptions options, double seconds_before_main)
        : options_(std::move(options)),
          seconds_before_(seconds_before_main),
          name_(options_.device.empty() ? "OpenCL" : "--device " + options_.device) {}

    /// If the first worker crashes, another one tries. If that crashes too, or one hangs, threads
    /// resume here from the journal.
    int run() {
        if (options_.scene == stdin_scene) keep_stdin();  // each worker reads it
        if (options_.fresh) remove_journal();
        WorkerEnd end = work({});
        if (!end.is_regular && !end.is_hung && end.stop_signal == 0) end = try_again(end);
        if (end.stop_signal != 0) end_by_stop_signal(end.stop_signal);
        if (end.is_regular) return end.status;
        if (options_.no_fallback) {
            throw Error(ExitCode::device, name_ + ": the driver process " + end.how);
        }
        say(end, "rendering on threads instead");
        if (options_.timeout > 0) {
            options_.timeout = std::max(options_.timeout - watch_.seconds(), 0.001);
        }
        options_.failed_device = name_;
        options_.device = "threads";
        return render_scene(options_, seconds_before_ + watch_.seconds());
    }

   private:
    /// Called once, before a worker leaves a journal there to be resumed.
    void remove_journal() {
        RenderOptions chosen = options_;
        choose_journal(chosen);
        if (!chosen.journal.empty()) {
            JournalFile file(chosen.journal);
            if (file.found() != JournalFile::Found::something_else) file.remove();
        }
        options_.fresh = false;
        std::erase(options_.command, "--fresh");
    }

    WorkerEnd work(const std::vector<std::string>& changes) const {
        return run_worker(options_.command, changes, options_.deadline,
                          seconds_before_ + watch_.seconds());
    }

    /// Without drivers that crash when listing their devices, else with an empty kernel cache.
    WorkerEnd try_again(const WorkerEnd& first) const {
        const IcdFiles files = try_icd_files(options_.drivers);
        const TemporaryFolder cache;
        const UsableIcdFiles usable(files);
        if (cache.name().empty() || usable.place().empty()) return first;
        if (!files.any_dangerous) {
            say(first, "trying again with an empty kernel cache");
            return work({"POCL_CACHE_DIR=" + cache.name()});
        }
        if (files.usable.empty()) return first;
        say(first, "trying again with the other drivers");
        const WorkerEnd second = work({"OCL_ICD_VENDORS=" + usable.place()});
        const bool lacks_device =
            second.is_regular && second.status == static_cast<int>(ExitCode::device);
        return lacks_device ? first : second;
    }

    void say(const WorkerEnd& end, const char* then) const {
        if (options_.quiet) return;
        print_message(
            fmt::format("mirrorball: {}: the driver process {}; {}\n", name_, end.how, then));
    }

    RenderOptions options_;
    const double seconds_before_;
    const std::string name_;
    const Stopwatch watch_;
};

int render_once(const RenderOptions& options, double seconds_before_main) {
    if (options.isolate && !is_worker() && needs_opencl(options.device)) {
        return IsolatedRender(options, seconds_before_main).run();
    }
    return render_scene(options, seconds_before_main);
}

}  // namespace

int run_render(const RenderOptions& options, double seconds_before_main) {
    if (options.mpi) return render_mpi(options);
    if (options.is_batch()) return render_batch(options);
    if (!options.watch || is_worker()) return render_once(options, seconds_before_main);
    return watch_scene(options.scene, options.quiet, [&] {
        return render_once(options, std::exchange(seconds_before_main, 0.0));
    });
}

}  // namespace rt
