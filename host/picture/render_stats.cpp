// SPDX-License-Identifier: Apache-2.0
#include "host/picture/render_stats.h"

#include <algorithm>

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

std::string RenderStats::failure() const {
    for (const DeviceShare& share : shares) {
        if (!share.failure.empty()) return share.failure;
    }
    return "";
}

void RenderStats::note_failed(const std::string& name, const std::string& how) {
    device.fallback_from = name;
    shares.insert(shares.begin(), {name, 0, 0, how});
}

std::vector<HierarchyStats> hierarchies_of(const FlattenStats& stats) {
    std::vector<HierarchyStats> list{
        {"spheres", stats.spheres}, {"cones", stats.cones}, {"triangles", stats.triangles}};
    std::erase_if(list, [](const HierarchyStats& one) { return one.shape.nodes == 0; });
    return list;
}

}  // namespace rt
