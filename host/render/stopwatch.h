// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace rt {

/// Seconds of wall clock since it was made or last restarted; monotonic.
class Stopwatch {
   public:
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

    /// Seconds so far, and starts over.
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
