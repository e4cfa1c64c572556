// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "host/image/picture.h"
#include "host/render/rect.h"
#include "host/view/viewer.h"

namespace rt {

/// Hands a picture in the making to viewers, all calls on a thread of its own: a slow viewer gets
/// fewer updates, and nobody waits for it but `finish`.
class LivePicture {
   public:
    explicit LivePicture(std::vector<std::unique_ptr<Viewer>> viewers);
    ~LivePicture();
    LivePicture(const LivePicture&) = delete;
    LivePicture& operator=(const LivePicture&) = delete;

    /// A picture of this size begins; the one before it, if any, was given up.
    void begin(int width, int height);

    /// Pixels of a part of the picture, three numbers each, row by row; from any thread.
    void put(const Rect& part, std::vector<float> rgb);

    /// Shows the picture as it stays. Once.
    void finish(const Picture& picture);

    /// After `finish`: until all windows are closed, or `is_stopped`.
    void wait(const std::function<bool()>& is_stopped);

   private:
    struct Part {
        Rect rect;
        std::vector<float> rgb;
    };

    void run();
    void add(const Part& part);
    void tell(bool begins, const std::vector<Rect>& parts);
    bool any_open() const;

    const std::vector<std::unique_ptr<Viewer>> viewers_;
    std::mutex mutex_;
    std::condition_variable changed_;
    int width_ = 0, height_ = 0;
    std::vector<Part> parts_;  ///< that no viewer knows yet
    bool has_begun_ = false;   ///< and no viewer knows yet
    const Picture* final_ = nullptr;
    bool is_shown_ = false;  ///< the final one
    bool is_done_ = false;
    Picture shown_;  ///< so far; the thread's own
    std::thread thread_;
};

}  // namespace rt
