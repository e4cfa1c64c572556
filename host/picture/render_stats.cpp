// SPDX-License-Identifier: Apache-2.0
#include "host/picture/render_stats.h"

#include <fmt/format.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "host/base/parallel.h"
#include "host/base/text.h"

namespace rt {

double RenderStats::rays_per_second() const {
    const double seconds = phases.renderer.trace;
    return seconds > 0 ? static_cast<double>(rays.total()) / seconds : 0;
}

bool RenderStats::driver_took_its_time() const {
    constexpr double short_picture = 0.2;
    const RendererTimes& times = phases.renderer;
    return times.kernel > 0 && times.trace > short_picture && times.kernel < times.trace / 2 &&
           !aa.refines();
}

double seconds_since_process_start() {
    std::ifstream file("/proc/self/stat");
    std::string text((std::istreambuf_iterator<char>(file)), {});
    // Field 22 is the start in clock ticks since boot; field 2, in parentheses, may hold anything.
    const auto name_end = text.rfind(')');
    if (name_end == std::string::npos) return 0;
    std::istringstream fields(text.substr(name_end + 1));
    std::string field;
    for (int i = 3; i <= 22; ++i) fields >> field;
    timespec now{};
    if (!fields || clock_gettime(CLOCK_BOOTTIME, &now) != 0) return 0;
    const double tick = 1 / static_cast<double>(sysconf(_SC_CLK_TCK));
    const double since_tick = static_cast<double>(now.tv_sec) +
                              1e-9 * static_cast<double>(now.tv_nsec) - tick * std::stod(field);
    return std::max(processor_seconds(), since_tick - tick);
}

std::string settings_text(const RenderStats& stats) {
    return fmt::format("{}x{}+{}+{} of {}x{}, {}, {} filter, {} bounces, {}, {} math",
                       stats.region.width, stats.region.height, stats.region.x, stats.region.y,
                       stats.width, stats.height, to_string(stats.aa), to_string(stats.filter),
                       stats.max_bounces, precision_name(stats.double_precision),
                       math_name(stats.fast_math));
}

std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace rt
