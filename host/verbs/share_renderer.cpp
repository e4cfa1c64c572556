// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/share_renderer.h"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>
#include <system_error>

#include "host/error.h"
#include "host/stop_signal.h"
#include "host/verbs/render_steps.h"

namespace rt {

namespace {

constexpr std::string_view part_prefix = "mpi-";

std::string parts_folder(const RenderOptions& options) { return options.output + ".parts"; }

}  // namespace

ShareRenderer::ShareRenderer(const RenderOptions& options)
    : options_(options),
      devices_(find_devices(options.device, options.threads, restore_stop_signals)),
      scene_(scene_to_render(options)),
      chosen_(devices_.get()) {
    events_.message = message_printer(options);
}

bool ShareRenderer::render(const ShareQueue::Turn& turn, int shares, const StopFlag& stop) {
    RenderSettings settings = options_;
    settings.shares = Shares{{turn.share}, shares};
    settings.journal = part_name(options_, turn, shares);
    const RenderStats stats =
        render_picture(scene_, settings, chosen_, events_, stop, &cache_).stats;
    prepare_for_next(chosen_, stats);
    return stats.complete();
}

std::string part_name(const RenderOptions& options, const ShareQueue::Turn& turn, int shares) {
    return fmt::format("{}/{}{}-of-{}.{}.mbj", parts_folder(options), part_prefix, turn.share,
                       shares, turn.attempt);
}

void make_parts_folder(const RenderOptions& options) {
    std::error_code error;
    std::filesystem::create_directories(parts_folder(options), error);
    if (!error) return;
    throw Error(ExitCode::output, fmt::format("{}: cannot make this folder: {}",
                                              parts_folder(options), error.message()));
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
