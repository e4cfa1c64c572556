// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace rt {

/// Chooses how many samples to launch at once so that a launch takes about a tenth of a second on
/// any device and scene: short enough for a watchdog, an interrupt and a progress bar, long enough
/// to keep a device busy. Starts small, since nothing is known yet, and learns from each launch.
class LaunchPacer {
   public:
    static constexpr double target_seconds = 0.1;
    static constexpr int most_growth = 8;  ///< from one launch to the next, which may be harder

    /// `first` samples to begin with, never more than `most`.
    LaunchPacer(std::int64_t first, std::int64_t most);

    /// Samples of the next launch, at least 1.
    std::int64_t samples() const { return samples_; }

    /// Records that a launch of that many samples took that long.
    void note(std::int64_t samples, double seconds);

   private:
    std::int64_t samples_;
    const std::int64_t most_;
};

}  // namespace rt
