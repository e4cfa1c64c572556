// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <future>
#include <optional>
#include <string>
#include <vector>

#include "host/journal/share_queue.h"
#include "host/opencl/device_spec.h"
#include "host/options/render_options.h"
#include "host/picture/render_cache.h"
#include "host/picture/render_picture.h"
#include "host/render/stopwatch.h"

namespace rt {

/// Renders shares of a scene, one after the other, each to a part file in OUTPUT.parts. Loads the
/// scene once. OpenCL drivers are loaded by a worker process for each share: they may crash. Once
/// one does, threads render the rest. The options must outlive it.
class ShareRenderer {
   public:
    /// Throws Error.
    explicit ShareRenderer(const RenderOptions& options);

    Rect region() const { return options_.crop.value_or(Rect{0, 0, scene_.width, scene_.height}); }

    /// Returns whether it finished, rather than being stopped. Throws Error.
    bool render(const ShareQueue::Turn& turn, int shares, const StopFlag& stop);

   private:
    std::optional<bool> render_in_worker(const std::string& share, const StopFlag& stop);

    const RenderOptions& options_;
    const Stopwatch watch_;
    bool is_isolated_;
    std::future<std::vector<DeviceChoice>> devices_;
    const Scene scene_;
    std::vector<DeviceChoice> chosen_;
    RenderEvents events_;
    RenderCache cache_;
};

/// The part file that a turn writes.
std::string part_name(const RenderOptions& options, const ShareQueue::Turn& turn, int shares);

/// Makes the folder for part files. Throws Error (ExitCode::output).
void make_parts_folder(const RenderOptions& options);

/// Removes the part files, and the folder unless something else is in it.
void remove_parts(const RenderOptions& options);

}  // namespace rt
