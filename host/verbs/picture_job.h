// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/image/picture.h"
#include "host/options/options.h"
#include "host/report/render_stats.h"
#include "host/scene/scene.h"

namespace rt {

struct RenderedPicture {
    Picture picture;  ///< the region, row 0 at the top; finished tiles only when stopped early
    RenderStats stats;
};

/// Says on stderr what a scene's reader left out.
void print_notes(const std::vector<std::string>& notes);

/// Gives the scene what the options override: size, AA, bounces.
void apply_overrides(Scene& scene, const RenderOptions& options);

/// Flattens the scene, chooses the device, and renders with progress on stderr. When the device
/// fails, the picture is rendered on threads instead, with a line on stderr, unless
/// options.no_fallback is on. SIGINT and SIGTERM end it early, with the tiles finished so far.
/// `when_tracing` is called when tracing begins, where other work can go on beside it and takes
/// nothing from it: the device is no CPU, or threads leave a core idle.
RenderedPicture render_picture(const Scene& scene, const RenderOptions& options,
                               const std::function<void()>& when_tracing = {});

}  // namespace rt
