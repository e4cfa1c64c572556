// SPDX-License-Identifier: Apache-2.0
#include "host/render/picture_loop.h"

#include <algorithm>
#include <span>

#include "host/render/adaptive.h"

namespace rt {

namespace {

constexpr int refine_passes = 2;

/// Samples of one call to refine, so that an interrupt is obeyed soon.
constexpr std::size_t samples_at_once = 1u << 20;

template <typename T>
void refine_all(Renderer<T>& renderer, const Refinement& refinement, TileQueue& queue,
                const Rect& region, Film<T>& film) {
    const auto samples = static_cast<std::size_t>(refinement.grid * refinement.grid);
    const std::size_t chunk = std::min<std::size_t>(
        samples_at_once / samples, static_cast<std::size_t>(renderer.most_tile_pixels()));
    const std::span<const std::int32_t> pixels(refinement.pixels);
    for (std::size_t at = 0; at < pixels.size() && !queue.stopped(); at += chunk) {
        renderer.refine(pixels.subspan(at, std::min(chunk, pixels.size() - at)), refinement.grid,
                        queue, region, film);
    }
}

}  // namespace

template <typename T>
void render_all(Renderer<T>& renderer, const AaMode& aa, TileQueue& queue, const Rect& region,
                Film<T>& film) {
    renderer.render(queue, region, film);
    if (aa.pattern != AaMode::Pattern::adaptive) return;
    std::vector<std::uint8_t> levels(static_cast<std::size_t>(region.pixels()), 1);
    for (int pass = 0; pass < refine_passes && !queue.stopped(); ++pass) {
        for (const Refinement& refinement : plan_refinement(film, aa.threshold, levels)) {
            refine_all(renderer, refinement, queue, region, film);
        }
    }
}

template void render_all(Renderer<float>&, const AaMode&, TileQueue&, const Rect&, Film<float>&);
template void render_all(Renderer<double>&, const AaMode&, TileQueue&, const Rect&, Film<double>&);

}  // namespace rt
