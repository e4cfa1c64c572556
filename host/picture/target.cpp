// SPDX-License-Identifier: Apache-2.0
#include "host/picture/target.h"

#include <fmt/format.h>

#include "host/picture/crew_members.h"

namespace rt {

RenderedPicture render_to_target(const Scene& scene, const RenderSettings& settings,
                                 const std::vector<DeviceChoice>& devices,
                                 const RenderEvents& events, const StopFlag& stop,
                                 RenderCache* cache) {
    RenderCache own;
    if (cache == nullptr) cache = &own;
    RenderSettings wanted = settings;
    wanted.estimate = true;
    wanted.kernels.any_samples = true;  // the same programs for both pictures
    RenderedPicture first = render_picture(scene, wanted, devices, events, stop, cache);
    if (!first.finer || stop != 0) return first;
    if (events.message) {
        events.message(fmt::format("RMSE {:.1e} with {}; rendering again with {}",
                                   first.stats.estimate->rmse, to_string(scene.aa),
                                   to_string(*first.finer)));
    }
    Scene finer = scene;
    finer.aa = *first.finer;
    wanted.controls = first.controls;
    RenderedPicture second = render_picture(finer, wanted, devices, events, stop, cache);
    if (!second.stats.complete()) return first;
    second.stats.estimate->seconds += first.stats.estimate->seconds;
    return second;
}

}  // namespace rt
