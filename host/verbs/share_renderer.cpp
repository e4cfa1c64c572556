// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/share_renderer.h"

#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <string_view>
#include <system_error>

#include "host/image/output_path.h"
#include "host/process/stop_signal.h"
#include "host/process/worker.h"
#include "host/verbs/render_steps.h"

namespace rt {

namespace {

constexpr std::string_view part_prefix = "mpi-";

std::string parts_folder(const RenderOptions& options) { return options.output + ".parts"; }

}  // namespace

ShareRenderer::ShareRenderer(const RenderOptions& options)
    : options_(options),
      is_isolated_(options.isolate && needs_opencl(options.device)),
      devices_(find_devices(is_isolated_ ? "threads" : options.device, options.threads,
                            restore_stop_signals)),
      scene_(scene_to_render(options)),
      chosen_(devices_.get()) {
    events_.message = message_printer(options);
}

bool ShareRenderer::render(const ShareQueue::Turn& turn, int shares, const StopFlag& stop) {
    RenderSettings settings = options_;
    settings.shares = Shares{{turn.share}, shares};
    settings.journal = part_name(options_, turn, shares);
    if (is_isolated_) {
        const std::string share = to_string(*settings.shares) + ":" + settings.journal;
        if (const auto is_finished = render_in_worker(share, stop)) return *is_finished;
    }
    const RenderStats stats =
        render_picture(scene_, settings, chosen_, events_, stop, &cache_).stats;
    prepare_for_next(chosen_, stats);
    return stats.complete();
}

/// Empty if its driver failed. Throws Error.
std::optional<bool> ShareRenderer::render_in_worker(const std::string& share,
                                                    const StopFlag& stop) {
    const WorkerEnd end = run_worker(
        {options_.command, {"MIRRORBALL_SHARE=" + share}, options_.deadline, watch_.seconds()});
    if (stop != 0 || end.stop_signal != 0) return false;
    if (end.is_regular && end.status == static_cast<int>(ExitCode::done)) return true;
    if (end.is_regular && end.status >= 128) return false;  // stopped
    if (end.is_regular && end.status == static_cast<int>(ExitCode::incomplete)) return false;
    if (end.is_regular) {
        throw Error(static_cast<ExitCode>(end.status),
                    fmt::format("its worker process ended with exit code {}", end.status));
    }
    const std::string failure = "the driver process " + end.how;
    if (options_.no_fallback) throw Error(ExitCode::device, failure);
    events_.message(failure + "; rendering on threads instead");
    is_isolated_ = false;
    return std::nullopt;
}

std::string part_name(const RenderOptions& options, const ShareQueue::Turn& turn, int shares) {
    return fmt::format("{}/{}{}-of-{}.{}.mbj", parts_folder(options), part_prefix, turn.share,
                       shares, turn.attempt);
}

void make_parts_folder(const RenderOptions& options) {
    create_output_folder(parts_folder(options));
}

void remove_parts(const RenderOptions& options) {
    std::error_code error;
    const std::filesystem::path folder = parts_folder(options);
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(part_prefix)) std::filesystem::remove(entry.path(), error);
    }
    std::filesystem::remove(folder, error);
}

}  // namespace rt
