// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "host/image/picture.h"
#include "host/opencl/device_spec.h"
#include "host/picture/render_settings.h"
#include "host/picture/render_stats.h"
#include "host/render/tile_queue.h"
#include "host/scene/scene.h"

namespace rt {

struct RenderCache;
class JournalFile;

struct RenderedPicture {
    Picture picture;  ///< the region, row 0 at the top; finished tiles only when stopped early
    RenderStats stats;
    std::shared_ptr<JournalFile>
        journal;  ///< locked, to be removed with the picture saved; or null
};

/// What the caller of render_picture hears of, on its own thread but where it says. Each may be
/// empty.
struct RenderEvents {
    std::function<void(const std::string& line)> message;  ///< what people should know
    std::function<void(const std::string& line)> detail;   ///< what they may want to know
    /// Tracing begins. The queue tells how far it is, to any thread, until `ended`.
    std::function<void(const TileQueue&)> started;
    std::function<void()> progressed;  ///< a tile or some pixels are finished; on any thread
    std::function<void()> ended;
    /// A picture of so many pixels begins, black so far; again if it has to start over.
    std::function<void(int width, int height)> began;
    /// Pixels of a part of it, three numbers each, row by row; on any thread. Not those that
    /// adaptive sampling renders a second time.
    std::function<void(const Rect& part, std::vector<float> rgb)> rendered;
    std::function<void()> driver_loaded;  ///< it may have replaced signal handlers; on any thread
};

/// Flattens the scene and renders it on the devices, which share its tiles. A device that fails
/// leaves the tiles it has finished to the picture, and the others or threads (unless
/// settings.no_fallback) do the rest; an event says so. The stop flag ends it early, with the tiles
/// finished so far. With settings.journal it goes on with what is there. Throws Error.
RenderedPicture render_picture(const Scene& scene, const RenderSettings& settings,
                               std::future<std::vector<DeviceChoice>> devices,
                               const RenderEvents& events, const StopFlag& stop);

/// On devices that were chosen before. The cache serves one picture at a time; null: nothing is
/// kept.
RenderedPicture render_picture(const Scene& scene, const RenderSettings& settings,
                               const std::vector<DeviceChoice>& devices, const RenderEvents& events,
                               const StopFlag& stop, RenderCache* cache = nullptr);

}  // namespace rt
