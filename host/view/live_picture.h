// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <vector>

#include "host/image/picture.h"
#include "host/render/rect.h"
#include "host/view/viewer.h"

namespace rt {

/// Passes a picture in progress to viewers, calling them all on its own thread: one that is slow or
/// hangs never delays the render.
class LivePicture {
   public:
    explicit LivePicture(std::vector<std::unique_ptr<Viewer>> viewers);
    LivePicture(const LivePicture&) = delete;
    LivePicture& operator=(const LivePicture&) = delete;

    /// Begins a picture of this size, in place of the previous one, if any.
    void begin(int width, int height);

    /// Adds the pixels of a rectangle, three numbers each, row by row; callable from any thread.
    void put(const Rect& part, std::vector<float> rgb);

    /// Shows the final picture, waiting up to five seconds for viewers that hang.
    void finish(Picture picture);

    /// After `finish`: waits until all windows are closed and viewers have the picture, or
    /// `is_stopped`.
    void wait(const std::function<bool()>& is_stopped);

    /// After `finish`: whether all windows are closed and viewers have the picture.
    bool is_over();

   private:
    struct Part {
        Rect rect;
        std::vector<float> rgb;
    };

    void run(const std::stop_token& stop);
    void add(const Part& part);
    void show_last(Picture picture);
    void tell(bool begins, const std::vector<Rect>& parts);
    bool any_open() const;

    const std::vector<std::unique_ptr<Viewer>> viewers_;
    std::mutex mutex_;
    std::condition_variable_any changed_;
    int width_ = 0, height_ = 0;
    std::vector<Part> parts_;  ///< not yet sent to viewers
    bool has_begun_ = false;   ///< begun, but not yet sent to viewers
    std::optional<Picture> final_;
    bool is_shown_ = false;  ///< the final picture is
    bool is_over_ = false;   ///< it is, and no viewer wants anything more
    Picture shown_;          ///< so far; used only by the thread
    std::jthread thread_;
};

}  // namespace rt
