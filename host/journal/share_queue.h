// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace rt {

/// Schedules shares on workers that may be slow or silently lost: first shares that nobody has
/// taken, then late ones again. Times are seconds of one clock.
class ShareQueue {
   public:
    /// An attempt at a share, and how many came before it.
    struct Turn {
        int share = 0, attempt = 0;
    };

    explicit ShareQueue(int shares) : shares_(static_cast<std::size_t>(shares)) {}

    /// Empty: nothing to do now; while is_done() is false, ask again later.
    std::optional<Turn> take(double now);

    /// A turn was finished; no effect if another turn finished its share first.
    void finish(const Turn& turn, double now);

    /// A turn will not be finished: its share may be taken again at once.
    void give_back(const Turn& turn);

    bool is_done() const { return done_ == shares_.size(); }

    /// The first finished turn of each share, once all are done.
    std::vector<Turn> finished() const;

   private:
    static constexpr double free_since_ever = -std::numeric_limits<double>::infinity();

    struct Share {
        int attempts = 0;
        double taken_at = free_since_ever;  ///< when it was last taken, unless given back
        std::optional<Turn> finished;       ///< the turn that finished it first
    };

    bool is_late(const Share& share, double now) const;

    std::vector<Share> shares_;
    std::size_t done_ = 0;
    double longest_ = 0;  ///< longest time that a share took, in seconds
};

}  // namespace rt
