// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "host/base/files.h"
#include "host/view/viewer.h"

namespace rt {

/// Sends the picture to the viewer tev: in each tick, what tev reads in a tenth of a second. If tev
/// cannot be reached, reads nothing for two seconds, or lacks some of the picture ten seconds after
/// `finish`, reports that once and sends no more of that picture.
class TevViewer : public Viewer {
   public:
    TevViewer(TevAddress address, std::string name, Say say);

    void begin(int width, int height) override;
    void update(const Picture& picture, std::span<const Rect> changed) override;
    void finish(const Picture& picture) override;
    void tick(const Picture& picture) override;
    bool is_open() const override { return socket_ && (!packets_.empty() || !parts_.empty()); }

   private:
    using Clock = std::chrono::steady_clock;

    void note(const Rect& part);
    void send(const Picture& picture);
    void give_up(const std::string& why);

    const TevAddress address_;
    const std::string name_;
    const Say say_;
    FileDescriptor socket_;
    std::deque<Rect> parts_;          ///< not yet in packets
    std::vector<std::byte> packets_;  ///< not yet sent, beginning at sent_
    std::size_t sent_ = 0;
    Clock::time_point last_sent_;
    Clock::time_point deadline_ = Clock::time_point::max();
};

}  // namespace rt
