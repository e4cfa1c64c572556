// SPDX-License-Identifier: Apache-2.0
#include "host/cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>

#include "host/base/console.h"
#include "host/view/viewer.h"

namespace rt {

namespace {

constexpr int widest_bar = 30, narrowest_bar = 5;
constexpr std::chrono::milliseconds bar_interval(100);
constexpr std::chrono::milliseconds line_interval(2000);

std::string eta_text(double fraction, double seconds) {
    if (fraction <= 0) return "-:--";
    const auto left = static_cast<long>(std::ceil(seconds * (1 - fraction) / fraction));
    return fmt::format("{}:{:02}", left / 60, left % 60);
}

}  // namespace

ProgressMode progress_mode_for_stderr(const RenderOptions& options) {
    if (options.progress != ProgressMode::automatic) return options.progress;
    if (options.quiet) return ProgressMode::none;
    const bool can_show_bar = isatty(STDERR_FILENO) == 1 && options.view.terminal != "dumb";
    return can_show_bar ? ProgressMode::bar : ProgressMode::plain;
}

std::string progress_line(double fraction, double seconds, const RayCounts& rays) {
    const double rate = seconds > 0 ? static_cast<double>(rays.total()) / seconds * 1e-6 : 0;
    // OpenCL devices count rays only at the end.
    const std::string rate_text = rate > 0 ? fmt::format("  {:.1f} Mrays/s", rate) : "";
    // Rounded down: 100 % means complete.
    return fmt::format("{:3.0f} %{}{}", std::floor(100 * fraction), rate_text,
                       fraction < 1 ? "  ETA " + eta_text(fraction, seconds) : "");
}

std::string progress_bar(double fraction, const std::string& line, int columns) {
    const int room = std::max(columns - 1, 0);  // the last column would wrap
    const int around = static_cast<int>(line.size()) + 3;
    const int width = std::min(widest_bar, room - around);
    std::string text = line;
    if (width >= narrowest_bar) {
        const int filled = static_cast<int>(fraction * width);
        text = fmt::format("[{:#<{}}{:.<{}}] {}", "", filled, "", width - filled, line);
    }
    // Pads with blanks to erase a longer previous line.
    return fmt::format("{:<{}}", text, room).substr(0, static_cast<std::size_t>(room));
}

ProgressReporter::ProgressReporter(const TileQueue& queue, ProgressMode mode)
    : queue_(queue), mode_(mode) {
    if (mode_ == ProgressMode::none) return;
    thread_ = std::jthread([this](const std::stop_token& ended) { run(ended); });
}

void ProgressReporter::run(const std::stop_token& ended) {
    const auto interval = mode_ == ProgressMode::plain ? line_interval : bar_interval;
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any wake;
    const auto is_over = [&] { return ended.stop_requested(); };
    while (!wake.wait_for(lock, ended, interval, is_over)) show(false);
    // A picture that finishes before anything is shown needs no bar.
    if (shown_ || mode_ == ProgressMode::json) show(true);
}

void ProgressReporter::show(bool last) {
    shown_ = true;
    const double fraction = queue_.fraction_finished();
    const double seconds = watch_.seconds();
    const RayCounts rays = queue_.rays();
    if (mode_ == ProgressMode::bar) {
        print_bar(
            progress_bar(fraction, progress_line(fraction, seconds, rays), terminal_size().columns),
            last);
    } else if (mode_ == ProgressMode::json) {
        print_message(fmt::format("{{\"fraction\":{:.4f},\"seconds\":{:.3f},\"rays\":{}}}\n",
                                  fraction, seconds, rays.total()));
    } else if (!last) {
        print_message(progress_line(fraction, seconds, rays) + "\n");
    }
}

}  // namespace rt
