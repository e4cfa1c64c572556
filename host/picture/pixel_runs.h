// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace rt {

/// Runs of pixels shared out among several renderers.
class PixelRuns {
   public:
    PixelRuns(std::span<const std::int32_t> pixels, std::size_t run) {
        for (std::size_t at = 0; at < pixels.size(); at += run) {
            runs_.push_back(pixels.subspan(at, std::min(run, pixels.size() - at)));
        }
    }
    std::optional<std::span<const std::int32_t>> take() {
        const std::scoped_lock lock(mutex_);
        if (runs_.empty()) return std::nullopt;
        const auto run = runs_.back();
        runs_.pop_back();
        return run;
    }
    void give_back(std::span<const std::int32_t> run) {
        const std::scoped_lock lock(mutex_);
        runs_.push_back(run);
    }
    bool empty() {
        const std::scoped_lock lock(mutex_);
        return runs_.empty();
    }

   private:
    std::mutex mutex_;
    std::vector<std::span<const std::int32_t>> runs_;
};

}  // namespace rt
