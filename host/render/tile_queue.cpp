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

TileQueue::TileQueue(std::vector<Rect> tiles, const StopFlag& stop,
                     std::function<void()> on_first_tile)
    : tiles_(std::move(tiles)), stop_(stop), on_first_tile_(std::move(on_first_tile)) {
    for (const Rect& tile : tiles_) pixels_ += tile.pixels();
}

std::optional<Rect> TileQueue::next() {
    if (stopped()) return std::nullopt;
    const std::size_t index = next_.fetch_add(1);
    if (index >= tiles_.size()) return std::nullopt;
    if (index == 0 && on_first_tile_) on_first_tile_();
    return tiles_[index];
}

void TileQueue::finish(const Rect& tile) {
    pixels_finished_ += tile.pixels();
    ++tiles_finished_;
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
