// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <future>
#include <string>
#include <vector>

#include "host/image/picture.h"
#include "host/measure/render_stats.h"
#include "host/options/options.h"
#include "host/render/device_spec.h"
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

/// The device that options ask for, looked for on a thread of its own: drivers take their time to
/// load (PoCL 0.03 s), and a scene can be read meanwhile. get() throws what goes wrong (Error); who
/// drops the future waits until the drivers are loaded.
std::future<DeviceChoice> find_device(const RenderOptions& options);

/// Flattens the scene and renders it on the device with progress on stderr. When the device
/// fails, the picture is rendered on threads instead, with a line on stderr, unless
/// options.no_fallback is on. SIGINT and SIGTERM end it early, with the tiles finished so far.
RenderedPicture render_picture(const Scene& scene, const RenderOptions& options,
                               std::future<DeviceChoice> device);

/// The same on the device that find_device gives.
RenderedPicture render_picture(const Scene& scene, const RenderOptions& options);

}  // namespace rt
