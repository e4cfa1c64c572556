// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "host/record/describe.h"
#include "host/render/rect.h"

namespace rt {

/// Rays traced, by kind.
struct RayCounts {
    std::uint64_t primary = 0, shadow = 0, mirror = 0, transmitted = 0;

    bool operator==(const RayCounts&) const = default;
    std::uint64_t total() const { return primary + shadow + mirror + transmitted; }
    RayCounts operator-(const RayCounts& other) const {
        return {primary - other.primary, shadow - other.shadow, mirror - other.mirror,
                transmitted - other.transmitted};
    }
};

template <typename A, Of<RayCounts> X>
void describe(A& a, X& x) {
    a("primary", x.primary, "eye rays");
    a("shadow", x.shadow, "towards lights");
    a("mirror", x.mirror, "reflected");
    a("transmitted", x.transmitted, "refracted");
    a("total", x.total(), "");
}

/// Cuts a region into tiles of at most the given size, row by row from the top left.
std::vector<Rect> make_tiles(const Rect& region, int tile_width, int tile_height);

/// Consecutive tiles that make up one rectangle.
struct TileRun {
    Rect whole;
    std::size_t tiles = 1;
    std::size_t first = 0;  ///< index of the first tile
};

/// Set by a signal handler to the signal's number; 0 while none has come.
using StopFlag = std::atomic<int>;
static_assert(StopFlag::is_always_lock_free);  // otherwise no signal handler may set it

/// The shared state of a picture in progress: hands out tiles until none is left or the stop flag
/// is set, and counts what is finished. Every member may be called from any thread.
class TileQueue {
   public:
    /// `finished` is called, on any thread, once a tile's pixels are in the film; it may be empty.
    TileQueue(std::vector<Rect> tiles, const StopFlag& stop,
              std::function<void(const Rect&)> finished = {});

    /// The next tile; empty if there is none or the work was stopped. A renderer finishes every
    /// tile it takes, or gives it back.
    std::optional<Rect> next();

    /// Like next, but takes as many of the next tiles as form a rectangle that `fits`; at least
    /// one.
    std::optional<TileRun> next_run(const std::function<bool(const Rect&)>& fits);

    /// Whether there is a next tile.
    bool has_tiles() const;

    void finish(const Rect& tile) { finish(TileRun{tile}); }
    void finish(const TileRun& run);

    /// Hands out again tiles that were taken and will not be finished.
    void give_back(const TileRun& run);

    /// Adds to the rays traced so far; for progress, and for the totals at the end.
    void add_rays(const RayCounts& rays);

    bool stopped() const { return stop_ != 0; }
    const std::vector<Rect>& tiles() const { return tiles_; }
    std::size_t tiles_finished() const { return tiles_finished_; }
    double fraction_finished() const;
    RayCounts rays() const;

   private:
    std::optional<std::size_t> next_returned();
    TileRun longest_run(std::size_t first, const std::function<bool(const Rect&)>& fits) const;

    const std::vector<Rect> tiles_;
    const StopFlag& stop_;
    const std::function<void(const Rect&)> finished_;
    std::int64_t pixels_ = 0;
    std::atomic<std::size_t> next_ = 0;
    std::mutex returned_mutex_;
    std::vector<std::size_t> returned_;  ///< tiles given back
    std::atomic<bool> any_returned_ = false;
    std::atomic<std::size_t> tiles_finished_ = 0;
    std::atomic<std::int64_t> pixels_finished_ = 0;
    std::atomic<std::uint64_t> primary_ = 0, shadow_ = 0, mirror_ = 0, transmitted_ = 0;
};

}  // namespace rt
