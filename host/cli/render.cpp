// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <system_error>
#include <thread>
#include <tuple>
#include <utility>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/parallel.h"
#include "host/cli/render_pictures.h"
#include "host/process/drivers.h"
#include "host/process/stop_signal.h"
#include "host/scene/scene_file.h"
#include "host/scene/text_file.h"

namespace rt {

namespace {

constexpr std::chrono::milliseconds look_interval(100);

FileStates states_of(FileStates files) {
    for (auto& [file, state] : files) state = state_of(file);
    return files;
}

/// Whether another scene may help.
bool concerns_scene(const Error& error) {
    const ExitCode code = error.exit_code();
    return code != ExitCode::usage && code != ExitCode::output && code != ExitCode::device;
}

/// Waits until `is_over`, or a file differs from `before` and has been left alone for a moment: an
/// editor may still be writing it.
void await_change(const std::string& scene, const FileStates& before,
                  const std::function<bool()>& is_over) {
    FileStates last = before;
    while (stop_flag() == 0 && !is_over()) {
        std::this_thread::sleep_for(look_interval);
        FileStates now = states_of(last);
        if (now != before && now == last && std::get<1>(now.at(scene)) > 0) return;
        last = std::move(now);
    }
}

/// Renders again, in the same viewers, whenever the scene's file or one of its models or their
/// material libraries changes, until the window is closed, with exit status 0, or a stop signal
/// comes, with the signal's; reports errors on stderr.
int render_and_watch(const RenderOptions& options, double seconds_before_main) {
    const std::string& scene = options.scene;
    const auto live = make_live_picture(options);
    const auto is_over = [&] { return options.view.window && live->is_over(); };
    FileStates files{{scene, {}}};
    for (bool is_first = true; stop_flag() == 0 && !is_over(); is_first = false) {
        files = states_of(files);
        take_asked_files();
        try {
            render_pictures(options, std::exchange(seconds_before_main, 0.0), live.get());
        } catch (const Error& error) {
            if (is_first && !concerns_scene(error)) throw;
            watch_worker("");
            print_error(error.what());
        }
        if (stop_flag() != 0 || is_over()) break;
        if (FileStates asked = take_asked_files(); asked.contains(scene)) files = std::move(asked);
        const bool was_quiet = stop_quietly(true);  // nothing is left to save
        if (!options.quiet) print_note("waiting for " + scene + " to change");
        await_change(scene, files, is_over);
        stop_quietly(was_quiet);
    }
    return stop_flag() == 0 ? 0 : exit_code_of_stop(stop_flag());
}

int render_here(const RenderOptions& options, double seconds_before_main) {
    if (options.watch) return render_and_watch(options, seconds_before_main);
    return render_pictures(options, options.is_batch() ? 0 : seconds_before_main, nullptr);
}

/// When the picture's journal was last written; the epoch if there is none.
std::filesystem::file_time_type journal_time(RenderOptions options) {
    choose_journal(options);
    std::error_code ignored;
    return std::filesystem::last_write_time(options.journal, ignored);
}

/// A worker gets extra time to save its picture at --timeout: its driver may never finish.
WorkerCommand worker_command(const RenderOptions& options, const Invocation& call) {
    WorkerCommand command{call.command, "", options.deadline, call.seconds_before_main};
    if (options.timeout > 0) command.longest = options.timeout + options.deadline;
    command.told = print_finished;
    return command;
}

/// Renders in a worker process, which loads the OpenCL drivers; if that fails, threads finish the
/// picture or batch in this one.
int render_isolated(RenderOptions options, const Invocation& call) {
    const Stopwatch watch;
    const std::string name = options.device.empty() ? "OpenCL" : "--device " + options.device;
    if (std::ranges::count(options.items, stdin_scene, &BatchItem::scene) > 0) keep_stdin();
    const auto journal_before = journal_time(options);
    const WorkerEnd end =
        run_without_bad_drivers(worker_command(options, call), call.drivers, options.quiet);
    if (end.is_regular) return end.status;
    const std::string failure = "the driver process " + end.how;
    if (options.no_fallback) {
        end_if_stopped(end);
        throw Error(ExitCode::device, name + ": " + failure);
    }
    install_stop_signals();  // what the worker has finished is saved
    if (end.stop_signal != 0) {
        note_stop(end.stop_signal);
    } else if (!options.quiet) {
        print_note(name + ": " + failure + "; rendering on threads instead");
    }
    // What the worker has written with --fresh is resumed.
    if (journal_time(options) != journal_before) options.fresh = false;
    if (options.timeout > 0) options.timeout = std::max(options.timeout - watch.seconds(), 0.001);
    if (!options.watch) options.batch_past = end.records;
    options.failed_device = name;
    options.device_failure = failure;
    options.device = "threads";
    options.kernels.lanes = 0;  // was for the device
    return render_here(options, call.seconds_before_main + watch.seconds());
}

}  // namespace

int run_render(const RenderOptions& options, const Invocation& call) {
    if (options.isolate && !is_worker() && needs_opencl(options.device)) {
        return render_isolated(options, call);
    }
    return render_here(options, call.seconds_before_main);
}

}  // namespace rt
