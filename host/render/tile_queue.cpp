// SPDX-License-Identifier: Apache-2.0
#include "host/render/tile_queue.h"

#include <algorithm>
#include <utility>

namespace rt {

std::vector<Rect> make_tiles(const Rect& region, int tile_width, int tile_height) {
    std::vector<Rect> tiles;
    for (int y = 0; y < region.height; y += tile_height) {
        for (int x = 0; x < region.width; x += tile_width) {
            tiles.push_back({region.x + x, region.y + y, std::min(tile_width, region.width - x),
                             std::min(tile_height, region.height - y)});
        }
    }
    return tiles;
}

namespace {

/// Tile `first` and the tiles to its right, as many as fit.
TileRun side_by_side(const std::vector<Rect>& tiles, std::size_t first,
                     const std::function<bool(const Rect&)>& fits) {
    TileRun run{tiles[first], 1, first};
    for (std::size_t i = first + 1; i < tiles.size(); ++i) {
        Rect wider = run.whole;
        wider.width += tiles[i].width;
        const Rect right{run.whole.x + run.whole.width, wider.y, tiles[i].width, wider.height};
        if (tiles[i] != right || !fits(wider)) break;
        run = {wider, run.tiles + 1, first};
    }
    return run;
}

}  // namespace

TileQueue::TileQueue(std::vector<Rect> tiles, const StopFlag& stop,
                     std::function<void(const Rect&)> finished)
    : tiles_(std::move(tiles)), stop_(stop), finished_(std::move(finished)) {
    for (const Rect& tile : tiles_) pixels_ += tile.pixels();
}

bool TileQueue::has_tiles() const {
    return !stopped() && tiles_finished_ < tiles_.size() &&
           (next_ < tiles_.size() || any_returned_);
}

std::optional<Rect> TileQueue::next() {
    if (stopped()) return std::nullopt;
    const std::size_t index = next_.fetch_add(1);
    if (index < tiles_.size()) return tiles_[index];
    if (const auto returned = next_returned()) return tiles_[*returned];
    return std::nullopt;
}

std::optional<TileRun> TileQueue::next_run(const std::function<bool(const Rect&)>& fits) {
    if (stopped()) return std::nullopt;
    std::size_t first = next_;
    while (first < tiles_.size()) {
        const TileRun run = longest_run(first, fits);
        if (next_.compare_exchange_weak(first, first + run.tiles)) return run;
    }
    if (const auto returned = next_returned()) return TileRun{tiles_[*returned], 1, *returned};
    return std::nullopt;
}

std::optional<std::size_t> TileQueue::next_returned() {
    if (!any_returned_) return std::nullopt;
    const std::scoped_lock lock(returned_mutex_);
    if (returned_.empty()) return std::nullopt;
    const std::size_t index = returned_.back();
    returned_.pop_back();
    any_returned_ = !returned_.empty();
    return index;
}

TileRun TileQueue::longest_run(std::size_t first,
                               const std::function<bool(const Rect&)>& fits) const {
    TileRun run = side_by_side(tiles_, first, fits);
    while (first + run.tiles < tiles_.size()) {
        const TileRun below = side_by_side(tiles_, first + run.tiles, [&](const Rect& row) {
            return row.width <= run.whole.width;
        });
        Rect taller = run.whole;
        taller.height += below.whole.height;
        const Rect bottom{taller.x, taller.y + run.whole.height, taller.width, below.whole.height};
        if (below.whole != bottom || !fits(taller)) break;
        run = {taller, run.tiles + below.tiles, first};
    }
    return run;
}

void TileQueue::finish(const TileRun& run) {
    if (finished_) finished_(run.whole);
    pixels_finished_ += run.whole.pixels();
    tiles_finished_ += run.tiles;
}

void TileQueue::give_back(const TileRun& run) {
    const std::scoped_lock lock(returned_mutex_);
    for (std::size_t i = run.tiles; i > 0; --i) returned_.push_back(run.first + i - 1);
    any_returned_ = true;
}

void TileQueue::add_rays(const RayCounts& rays) {
    primary_ += rays.primary;
    shadow_ += rays.shadow;
    mirror_ += rays.mirror;
    transmitted_ += rays.transmitted;
}

double TileQueue::fraction_finished() const {
    if (pixels_ == 0) return 1;
    return static_cast<double>(pixels_finished_) / static_cast<double>(pixels_);
}

RayCounts TileQueue::rays() const { return {primary_, shadow_, mirror_, transmitted_}; }

}  // namespace rt
