// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

#include "host/render/renderer.h"

namespace rt {

/// A whole picture in tiles of this size, or the renderer's; and how many rays it took.
template <typename T>
Film<T> whole_film(Renderer<T>& renderer, int width, int height, Rect tile = {},
                   RayCounts* rays = nullptr) {
    static const StopFlag never_stop = 0;
    if (tile.width == 0) tile = renderer.tile_sizes(width).best;
    const Rect whole{0, 0, width, height};
    TileQueue queue(make_tiles(whole, tile.width, tile.height), never_stop);
    Film<T> film(width, height);
    renderer.render(queue, whole, film);
    if (queue.tiles_finished() != queue.tiles().size()) throw std::logic_error("unfinished tiles");
    if (rays != nullptr) *rays = queue.rays();
    return film;
}

}  // namespace rt
