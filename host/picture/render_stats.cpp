// SPDX-License-Identifier: Apache-2.0
#include "host/picture/render_stats.h"

#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "host/base/parallel.h"

namespace rt {

double RenderStats::rays_per_second() const {
    const double seconds = phases.renderer.trace;
    return seconds > 0 ? static_cast<double>(rays.total()) / seconds : 0;
}

bool RenderStats::driver_took_its_time() const {
    constexpr double short_picture = 0.2;
    const RendererTimes& times = phases.renderer;
    return times.kernel > 0 && times.trace > short_picture && times.kernel < times.trace / 2 &&
           !picture.aa.refines();
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

std::vector<HierarchyStats> hierarchies_of(const FlattenStats& stats) {
    std::vector<HierarchyStats> list{
        {"spheres", stats.spheres}, {"cones", stats.cones}, {"triangles", stats.triangles}};
    std::erase_if(list, [](const HierarchyStats& one) { return one.shape.nodes == 0; });
    return list;
}

}  // namespace rt
