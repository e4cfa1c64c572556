// SPDX-License-Identifier: Apache-2.0
#include "host/render/picture_loop.h"

#include <algorithm>

#include "host/render/launch_pacer.h"
#include "host/render/stopwatch.h"

namespace rt {

namespace {

/// Samples in the first call to refine, and in the largest.
constexpr std::int64_t first_samples = 1 << 17, most_samples = 1 << 24;

/// Returns whether all were refined.
template <typename T>
bool refine_all(Renderer<T>& renderer, const Refinement& refinement, LaunchPacer& pacer,
                TileQueue& queue, const Rect& region, Film<T>& film,
                const std::function<void(std::span<const std::int32_t>)>& refined) {
    const std::int64_t samples = refinement.grid * refinement.grid;
    std::span<const std::int32_t> pixels(refinement.pixels);
    while (!pixels.empty() && !queue.stopped()) {
        const std::int64_t most = std::min(std::max<std::int64_t>(pacer.samples() / samples, 1),
                                           renderer.most_tile_pixels());
        const std::size_t count = std::min(pixels.size(), static_cast<std::size_t>(most));
        const Stopwatch watch;
        renderer.refine(pixels.first(count), refinement.grid, queue, region, film);
        pacer.note(static_cast<std::int64_t>(count) * samples, watch.seconds());
        if (queue.stopped()) return false;  // a device may have left some to others
        refined(pixels.first(count));
        pixels = pixels.subspan(count);
    }
    return pixels.empty();
}

}  // namespace

Rect region_to_render(const AaMode& aa, const Rect& wanted, int picture_width, int picture_height) {
    if (!aa.refines()) return wanted;
    const int left = std::max(wanted.x - refine_passes, 0);
    const int top = std::max(wanted.y - refine_passes, 0);
    const int right = std::min(wanted.x + wanted.width + refine_passes, picture_width);
    const int bottom = std::min(wanted.y + wanted.height + refine_passes, picture_height);
    return {left, top, right - left, bottom - top};
}

template <typename T>
RenderedAll render_all(Renderer<T>& renderer, const AaMode& aa, TileQueue& queue,
                       const Rect& region, Film<T>& film, const RefineEvents<T>& events) {
    renderer.render(queue, region, film);
    if (queue.tiles_finished() < queue.tiles().size()) return {};
    if (!aa.refines()) return {true};
    RenderedAll result;
    std::vector<std::uint8_t> levels(static_cast<std::size_t>(region.pixels()), 1);
    LaunchPacer pacer(first_samples, most_samples);
    for (int pass = 0; pass < refine_passes; ++pass) {
        const auto refined = [&](std::span<const std::int32_t> pixels) {
            if (events.refined) events.refined(pass, pixels);
        };
        const Stopwatch planning;
        std::vector<Refinement> plan = plan_refinement(film, aa.threshold, levels);
        result.plan_seconds += planning.seconds();
        if (events.planned) events.planned(pass, plan, film);
        for (const Refinement& refinement : plan) {
            if (!refine_all(renderer, refinement, pacer, queue, region, film, refined)) {
                return result;
            }
        }
    }
    result.is_finished = true;
    return result;
}

template RenderedAll render_all(Renderer<float>&, const AaMode&, TileQueue&, const Rect&,
                                Film<float>&, const RefineEvents<float>&);
template RenderedAll render_all(Renderer<double>&, const AaMode&, TileQueue&, const Rect&,
                                Film<double>&, const RefineEvents<double>&);

}  // namespace rt
