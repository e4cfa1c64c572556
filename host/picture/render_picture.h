// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/image/picture.h"
#include "host/opencl/devices.h"
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

/// Events for the caller of render_picture, on its own thread unless noted. Each may be empty.
struct RenderEvents {
    std::function<void(const std::string& line)> message;  ///< what users should know
    std::function<void(const std::string& line)> detail;   ///< what they may want to know
    /// These begin to work, OpenCL devices among them, until `ended`.
    std::function<void(const std::string& devices)> opening;
    /// Tracing begins. Until `ended`, any thread may ask the queue for progress.
    std::function<void(const TileQueue&)> started;
    std::function<void()> progressed;  ///< a tile or some pixels are finished; on any thread
    std::function<void()> ended;
    /// A picture of this size begins, black so far; called again if it has to start over.
    std::function<void(int width, int height)> began;
    /// The RGB of the pixels in a part of it, row by row; on any thread. Not for pixels that
    /// adaptive sampling renders a second time.
    std::function<void(const Rect& part, std::vector<float> rgb)> rendered;
    std::function<void()> driver_loaded;  ///< it may have replaced signal handlers; on any thread
};

/// Flattens the scene and renders it on the devices, which share its tiles. If a device fails, the
/// tiles it has finished stay, and the others or threads (unless settings.no_fallback) do the rest;
/// an event says so. The stop flag ends it early, with the tiles finished so far. With
/// settings.journal it resumes. With settings.target_rmse, it renders first with the scene's AA
/// mode, which must not refine, and if the estimated error is larger, once more with as many
/// samples as it takes; the first picture is the result if the second is stopped. Throws Error.
///
/// `devices` is called once the scene is flattened. The cache serves one picture at a time, and
/// devices are warned of in the first only; null: no cache.
RenderedPicture render_picture(const Scene& scene, RenderSettings settings,
                               const std::function<std::vector<DeviceChoice>()>& devices,
                               const RenderEvents& events, const StopFlag& stop,
                               RenderCache* cache = nullptr);

/// The devices for the next picture of several: threads, if one of these failed.
void leave_out_failed(std::vector<DeviceChoice>& devices, const RenderStats& stats);

}  // namespace rt
