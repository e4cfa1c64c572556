// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/isolated_render.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/process/drivers.h"
#include "host/render/stopwatch.h"
#include "host/scene/scene_file.h"
#include "host/scene/stdin_text.h"
#include "host/verbs/render_steps.h"

namespace rt {

namespace {

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

}  // namespace

int render_isolated(RenderOptions options, double seconds_before_main,
                    const RenderHere& render_here) {
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

}  // namespace rt
