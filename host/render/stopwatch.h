// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace rt {

/// Wall-clock seconds since construction or the last restart; monotonic.
class Stopwatch {
   public:
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

    /// Returns the seconds so far and restarts.
    double lap() {
        const Clock::time_point now = Clock::now();
        const double elapsed = std::chrono::duration<double>(now - start_).count();
        start_ = now;
        return elapsed;
    }

   private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

}  // namespace rt
