// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace rt {

/// Chooses how many samples to launch at once so that a launch takes about a tenth of a second on
/// any device and scene: short enough for a watchdog, an interrupt and a progress bar, long enough
/// to keep a device busy. Starts small, since nothing is known yet, and learns from each launch.
class LaunchPacer {
   public:
    static constexpr double target_seconds = 0.1;
    static constexpr int most_growth = 8;  ///< from one launch to the next, which may be harder

    /// `first` samples to begin with, never more than `most` and, if that is not more, never fewer
    /// than `least`: fewer than a device runs at once would not be faster.
    LaunchPacer(std::int64_t first, std::int64_t most, std::int64_t least = 1)
        : least_(std::min(least, most)), most_(most), samples_(std::clamp(first, least_, most)) {}

    /// Samples of the next launch.
    std::int64_t samples() const { return samples_; }

    /// Records that a launch of that many samples took that long.
    void note(std::int64_t samples, double seconds) {
        // Written so that a clock that does not advance means most_growth.
        const bool is_long = target_seconds < seconds * most_growth;
        const double growth = is_long ? target_seconds / seconds : double{most_growth};
        const double wanted = static_cast<double>(samples) * growth;
        samples_ = static_cast<std::int64_t>(
            std::clamp(wanted, static_cast<double>(least_), static_cast<double>(most_)));
    }

   private:
    const std::int64_t least_, most_;
    std::int64_t samples_;
};

}  // namespace rt
