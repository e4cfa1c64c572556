// SPDX-License-Identifier: Apache-2.0
#include "host/journal/share_queue.h"

#include <algorithm>

namespace rt {

/// Also true of free shares. Generous: shares differ in cost, and a machine may be busy for a
/// while.
bool ShareQueue::is_late(const Share& share, double now) const {
    constexpr double usual_times = 2, least_seconds = 1;
    return now - share.taken_at > std::max(least_seconds, usual_times * longest_);
}

std::optional<ShareQueue::Turn> ShareQueue::take(double now) {
    Share* oldest = nullptr;
    for (Share& share : shares_) {
        if (share.finished) continue;
        if (oldest == nullptr || share.taken_at < oldest->taken_at) oldest = &share;
    }
    if (oldest == nullptr || !is_late(*oldest, now)) return std::nullopt;
    oldest->taken_at = now;
    return Turn{static_cast<int>(oldest - shares_.data()), oldest->attempts++};
}

void ShareQueue::finish(const Turn& turn, double now) {
    Share& share = shares_[static_cast<std::size_t>(turn.share)];
    if (share.finished) return;
    if (turn.attempt == share.attempts - 1) longest_ = std::max(longest_, now - share.taken_at);
    share.finished = turn;
    ++done_;
}

void ShareQueue::give_back(const Turn& turn) {
    Share& share = shares_[static_cast<std::size_t>(turn.share)];
    if (turn.attempt == share.attempts - 1) share.taken_at = free_since_ever;
}

std::vector<ShareQueue::Turn> ShareQueue::finished() const {
    std::vector<Turn> turns;
    for (const Share& share : shares_) {
        if (share.finished) turns.push_back(*share.finished);
    }
    return turns;
}

}  // namespace rt
