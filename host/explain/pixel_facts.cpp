// SPDX-License-Identifier: Apache-2.0
#include "host/explain/pixel_facts.h"

#include <cstddef>

#include "host/base/parallel.h"
#include "host/explain/ray_tree.h"
#include "host/flatten/view_frame.h"
#include "host/render/native_kernels.h"
#include "host/render/tile_queue.h"
#include "host/render/tile_rounds.h"

namespace rt {

namespace {

/// What each pixel of a strip, pixels below each other, counts beyond its eye rays; in adaptive and
/// edges modes also the samples beyond that at its center.
template <typename T>
auto counts_of(const NativeKernels<T>& kernels, const NativeView<T>& view, const Rect& strip) {
    using Index = typename Flat<T>::Index;
    const auto height = static_cast<std::size_t>(strip.height);
    std::vector<typename Flat<T>::RayCounts> counts(height);
    std::vector<T> film(3 * height);
    for (std::size_t i = 0; i < height; ++i) {
        const Rect pixel{strip.x, strip.y + static_cast<int>(i), 1, 1};
        const auto tile = flat_tile<T>(pixel, pixel);
        kernels.render_pixels(film.data(), &counts[i], &view, &tile, 0, 1);
    }
    if (!renders_in_rounds(view.params)) return counts;
    const auto tile = flat_tile<T>(strip, strip);
    const int margin = tile_margin(view.params);
    const auto wide = size_with_margin(tile, margin);
    std::vector<T> planes(plane_values(view.params, tile, kernels.lanes));
    typename Flat<T>::RayCounts ignored{};
    kernels.render_centers(planes.data(), &ignored, &view, &tile, 0,
                           wide.width * wide.height);  // packets of a pixel, or more
    // Row by row, each of which has one pixel that is not in the margin.
    const int rounds = round_count(view.params);
    for (int round = 0; round < rounds; ++round) {
        const int around = rounds - 1 - round;
        const Index across = (1 + 2 * around + kernels.lanes - 1) / kernels.lanes;
        for (Index row = 0; row < strip.height + 2 * around; ++row) {
            const auto i = static_cast<std::size_t>(row - around);  // huge in the margin above
            kernels.render_round(film.data(), i < height ? &counts[i] : &ignored, &view, &tile,
                                 planes.data(), round, row * across, (row + 1) * across);
        }
    }
    return counts;
}

}  // namespace

PixelHits pixel_hits(const Scene& scene, const Rect& region, const StopFlag& stop) {
    Scene centers = scene;
    centers.aa = grid_aa(1);
    centers.filter = Filter::box;
    centers.max_bounces = 0;
    const FlatScene<double> flat = flatten<double>(centers);
    const double scale = make_view_frame(centers, TriangleList(centers), 1).scale;
    const auto pixels = static_cast<std::size_t>(region.pixels());
    PixelHits hits{std::vector<float>(pixels), std::vector<float>(3 * pixels),
                   std::vector<std::int32_t>(pixels)};
    const auto note_pixel = [&](std::size_t i) {
        const int x = region.x + static_cast<int>(i) % region.width;
        const int y = region.y + static_cast<int>(i) / region.width;
        for (const PathEvent& event : explain_pixel(flat, x, y).events) {
            if (event.what != RT_EVENT_HIT) continue;
            hits.depth[i] = static_cast<float>(event.distance / scale);
            hits.id[i] = static_cast<std::int32_t>(number_in_scene(flat, event.index)) + 1;
            for (std::size_t k = 0; k < 3; ++k) {
                hits.normal[3 * i + k] = static_cast<float>(event.normal[k]);
            }
        }
    };
    for_each_run(pixels, 64, available_cores(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last && stop == 0; ++i) note_pixel(i);
    });
    return hits;
}

template <typename T>
PixelWork pixel_work(const Scene& scene, const Rect& region, const StopFlag& stop) {
    const FlatScene<T> flat = flatten<T>(scene);
    ThreadsOptions options;
    options.kernels.any_samples = true;
    const NativeKernels<T>& kernels = native_kernels_for(flat, options);
    const NativeView<T> view = native_view(flat);
    const auto pixels = static_cast<std::size_t>(region.pixels());
    PixelWork work{std::vector<std::uint32_t>(pixels), std::vector<std::uint64_t>(pixels)};
    const std::vector<Rect> strips = make_tiles(region, 1, 64);
    for_each_run(strips.size(), 1, available_cores(), [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last && stop == 0; ++k) {
            int y = strips[k].y;
            for (const auto& counts : counts_of(kernels, view, strips[k])) {
                const std::size_t i = index_in(region, strips[k].x, y++);
                const auto samples =
                    static_cast<std::uint64_t>(flat.params.samples) + counts.primary;
                work.samples[i] = static_cast<std::uint32_t>(samples);
                work.rays[i] = samples + counts.shadow + counts.mirror + counts.transmitted;
            }
        }
    });
    return work;
}

template PixelWork pixel_work<float>(const Scene&, const Rect&, const StopFlag&);
template PixelWork pixel_work<double>(const Scene&, const Rect&, const StopFlag&);

}  // namespace rt
