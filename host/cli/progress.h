// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <string>
#include <thread>

#include "host/base/parallel.h"
#include "host/cli/render_options.h"
#include "host/render/tile_queue.h"

namespace rt {

/// The value of --progress with `auto` resolved: nothing when quiet, a bar on a terminal that can
/// show one, plain lines elsewhere.
ProgressMode progress_mode_for_stderr(const RenderOptions& options);

/// One line of progress: "42 %  12.3 Mrays/s  ETA 0:07"; no ETA when all is done.
std::string progress_line(double fraction, double seconds, const RayCounts& rays);

/// The line after a bar that fills a terminal of `columns` columns, padded with blanks.
std::string progress_bar(double fraction, const std::string& line, int columns);

/// Shows a queue's progress on stderr, from its own thread, until destroyed.
class ProgressReporter {
   public:
    ProgressReporter(const TileQueue& queue, ProgressMode mode);
    ProgressReporter(const ProgressReporter&) = delete;
    ProgressReporter& operator=(const ProgressReporter&) = delete;

   private:
    void run(const std::stop_token& ended);
    void show(bool last);

    const TileQueue& queue_;
    const ProgressMode mode_;
    const Stopwatch watch_;
    bool shown_ = false;
    std::jthread thread_;
};

}  // namespace rt
