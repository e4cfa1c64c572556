// SPDX-License-Identifier: Apache-2.0
#include "host/picture/render_settings.h"

#include "host/base/error.h"

namespace rt {

namespace {

/// An edges mode takes the mean of a pixel's own area.
void check_filter(const Scene& scene) {
    const int fewest = fewest_samples(scene.filter);
    if (scene.aa.pattern == AaMode::Pattern::sobol && scene.aa.count < fewest) {
        usage_error("--filter {} requires at least sobol:{}; {} is too few",
                    to_string(scene.filter), fewest, to_string(scene.aa));
    }
    if (scene.aa.finds_edges() && scene.filter != Filter::box) {
        usage_error("--filter {} cannot be combined with {}; use the box filter or another --aa",
                    to_string(scene.filter), to_string(scene.aa));
    }
}

}  // namespace

void apply_overrides(Scene& scene, const RenderSettings& settings) {
    if (settings.size) set_image_size(scene, settings.size->width, settings.size->height);
    if (settings.aa) scene.aa = *settings.aa;
    scene.filter = settings.filter;
    scene.sampling_seed = settings.seed;
    check_filter(scene);
    if (settings.max_bounces) scene.max_bounces = *settings.max_bounces;
}

PictureSpec picture_spec(const Scene& scene, const RenderSettings& settings) {
    const Rect whole{0, 0, scene.width, scene.height};
    const Rect region = settings.crop.value_or(whole);
    if (region.x + region.width > whole.width || region.y + region.height > whole.height) {
        usage_error("--crop extends to {},{}, but the picture has {}x{} pixels",
                    region.x + region.width, region.y + region.height, whole.width, whole.height);
    }
    return {scene.width,       scene.height,       region,
            scene.aa,          scene.filter,       scene.sampling_seed,
            scene.max_bounces, settings.precision, settings.math};
}

RenderSettings settings_for(const PictureSpec& spec) {
    RenderSettings settings;
    settings.size = {spec.width, spec.height};
    settings.crop = spec.region;
    settings.aa = spec.aa;
    settings.filter = spec.filter;
    settings.seed = spec.seed;
    settings.max_bounces = spec.max_bounces;
    settings.precision = spec.precision;
    settings.math = spec.math;
    return settings;
}

}  // namespace rt
