// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>

#include "host/flatten/flat_types.h"
#include "host/render/film.h"
#include "host/render/tile_queue.h"

namespace rt {

/// Where a renderer's time went, in wall-clock seconds; 0 for steps it does not have.
struct RendererTimes {
    double open = 0;          ///< find the device, make context and queue
    double build = 0;         ///< compile or load the kernels
    double upload = 0;        ///< scene to device
    double check = 0;         ///< its self-test
    double trace = 0;         ///< first ray to last
    double kernel = 0;        ///< of that, kernels running, by the device's own clock
    double resolve = 0;       ///< average sample buffers, where that is a pass of its own
    double read_back = 0;     ///< film to host
    std::int64_t pixels = 0;  ///< rendered
};

/// The tiles that suit a renderer.
struct TileSizes {
    Rect best;                                                   ///< the default: width and height
    std::int64_t most_pixels = std::numeric_limits<int>::max();  ///< no tile may have more
};

/// One flattened scene on one device, ready to render. A tile's pixels depend on the flat scene
/// alone, not on which renderer does the tile, when, or how often.
template <typename T>
class Renderer {
   public:
    virtual ~Renderer() = default;

    virtual TileSizes tile_sizes(int film_width) const = 0;

    /// Renders the queue's tiles, black so far, into the film, which shows `region` of the picture;
    /// returns when the queue is empty or stopped, with every tile it took finished. Throws Error
    /// (ExitCode::device) if the device fails; the queue then counts only tiles as finished whose
    /// pixels are in the film.
    virtual void render(TileQueue& queue, const Rect& region, Film<T>& film) = 0;

    virtual RendererTimes times() const = 0;
};

/// A region as one tile, and how many rays it took.
template <typename T>
std::pair<Film<T>, RayCounts> render_region(Renderer<T>& renderer, const Rect& region) {
    static const StopFlag never_stopped{0};
    Film<T> film(region.width, region.height);
    TileQueue queue({region}, never_stopped);
    renderer.render(queue, region, film);
    return {std::move(film), queue.rays()};
}

/// Traces rays outside a picture, with all features compiled in: one answer per query
/// (kernels/rays.cl). Throws Error (ExitCode::device) if the device fails. For one thread at a
/// time; the scene must outlive it.
template <typename T>
using RayTracer = std::function<void(std::span<const typename Flat<T>::RayQuery> queries,
                                     std::span<typename Flat<T>::RayAnswer> answers)>;

/// The shared launch descriptor of a tile, in a film that shows `region`.
template <typename T>
typename Flat<T>::Tile flat_tile(const Rect& tile, const Rect& region) {
    typename Flat<T>::Tile flat{};
    flat.x = tile.x;
    flat.y = tile.y;
    flat.width = tile.width;
    flat.height = tile.height;
    flat.first = (tile.y - region.y) * region.width + (tile.x - region.x);
    flat.film_width = region.width;
    return flat;
}

}  // namespace rt
