// SPDX-License-Identifier: Apache-2.0
#include "host/picture/render_settings.h"

#include "host/base/error.h"

namespace rt {

namespace {

/// The cubic has negative weights: a handful of scattered samples may add up to nothing.
void check_filter(const Scene& scene) {
    constexpr int fewest = 16;
    if (scene.filter == Filter::mitchell && scene.aa.pattern == AaMode::Pattern::sobol &&
        scene.aa.count < fewest) {
        usage_error("--filter mitchell requires at least sobol:{}; {} is too few", fewest,
                    to_string(scene.aa));
    }
}

}  // namespace

void apply_overrides(Scene& scene, const RenderSettings& settings) {
    if (settings.size) set_image_size(scene, settings.size->width, settings.size->height);
    if (settings.aa) scene.aa = *settings.aa;
    scene.filter = settings.filter;
    scene.sampling_seed = settings.sampling_seed;
    check_filter(scene);
    if (settings.max_bounces) scene.max_bounces = *settings.max_bounces;
}

}  // namespace rt
