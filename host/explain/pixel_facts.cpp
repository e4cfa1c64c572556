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

/// Calls work(index, x, y) for the pixels of a region on all threads, until stopped.
template <typename Work>
void for_each_pixel(const Rect& region, const StopFlag& stop, const Work& work) {
    const auto width = static_cast<std::size_t>(region.width);
    for_each_run(static_cast<std::size_t>(region.height), 1, available_cores(),
                 [&](std::size_t first, std::size_t last) {
                     for (std::size_t i = first * width; i < last * width && stop == 0; ++i) {
                         work(i, region.x + static_cast<int>(i % width),
                              region.y + static_cast<int>(i / width));
                     }
                 });
}

/// What each pixel of a region counts, beyond its eye rays; in adaptive and edges modes also the
/// samples beyond that at its center.
template <typename T>
class PixelCounter {
   public:
    using Counts = typename Flat<T>::RayCounts;

    PixelCounter(const FlatScene<T>& scene, const Rect& region)
        : kernels_(native_kernels_for(scene, any_samples())),
          view_(native_view(scene)),
          region_(region),
          counts_(static_cast<std::size_t>(region.pixels())) {}

    const Counts& operator[](std::size_t i) const { return counts_[i]; }
    std::uint64_t samples() const { return static_cast<std::uint64_t>(view_.params.samples); }

    /// For a strip of pixels below each other.
    void count(const Rect& strip) {
        std::vector<T> film(3 * static_cast<std::size_t>(strip.pixels()));
        for (int y = strip.y; y < strip.y + strip.height; ++y) {
            const auto pixel = flat_tile<T>({strip.x, y, 1, 1}, {strip.x, y, 1, 1});
            kernels_.render_pixels(film.data(), &at(strip.x, y), &view_, &pixel, 0, 1);
        }
        if (renders_in_rounds(view_.params)) count_rounds(strip, film.data());
    }

   private:
    using Index = typename Flat<T>::Index;

    static ThreadsOptions any_samples() {
        ThreadsOptions options;
        options.kernels.any_samples = true;
        return options;
    }

    Counts& at(int x, int y) { return counts_[index_in(region_, x, y)]; }

    /// Row by row, each of which has one pixel that is not in the strip's margin.
    void count_rounds(const Rect& strip, T* film) {
        const auto tile = flat_tile<T>(strip, strip);
        const int margin = tile_margin(view_.params);
        const auto wide = size_with_margin(tile, margin);
        std::vector<T> planes(plane_values(view_.params, tile, kernels_.lanes));
        Counts ignored{};
        kernels_.render_centers(planes.data(), &ignored, &view_, &tile, 0,
                                wide.width * wide.height);  // packets of a pixel, or more
        const auto render = round_kernel(kernels_, view_.params);
        for (int round = 0; round < margin; ++round) {
            const int around = margin - 1 - round;
            const Index across = (1 + 2 * around + kernels_.lanes - 1) / kernels_.lanes;
            for (Index row = 0; row < strip.height + 2 * around; ++row) {
                const int y = strip.y + static_cast<int>(row) - around;
                const bool is_margin = y < strip.y || y >= strip.y + strip.height;
                render(film, is_margin ? &ignored : &at(strip.x, y), &view_, &tile, planes.data(),
                       round, row * across, (row + 1) * across);
            }
        }
    }

    const NativeKernels<T>& kernels_;
    const NativeView<T> view_;
    const Rect region_;
    std::vector<Counts> counts_;
};

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
    for_each_pixel(region, stop, [&](std::size_t i, int x, int y) {
        for (const PathEvent& event : explain_pixel(flat, x, y).events) {
            if (event.what != RT_EVENT_HIT) continue;
            hits.depth[i] = static_cast<float>(event.distance / scale);
            hits.id[i] = static_cast<std::int32_t>(number_in_scene(flat, event.index)) + 1;
            for (std::size_t k = 0; k < 3; ++k) {
                hits.normal[3 * i + k] = static_cast<float>(event.normal[k]);
            }
        }
    });
    return hits;
}

template <typename T>
PixelWork pixel_work(const Scene& scene, const Rect& region, const StopFlag& stop) {
    const FlatScene<T> flat = flatten<T>(scene);
    PixelCounter<T> counter(flat, region);
    const std::vector<Rect> strips = make_tiles(region, 1, 64);
    for_each_run(strips.size(), 1, available_cores(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last && stop == 0; ++i) counter.count(strips[i]);
    });
    const auto pixels = static_cast<std::size_t>(region.pixels());
    PixelWork work{std::vector<std::uint32_t>(pixels), std::vector<std::uint64_t>(pixels)};
    for (std::size_t i = 0; i < pixels; ++i) {
        const auto& counts = counter[i];
        const std::uint64_t samples = counter.samples() + counts.primary;
        work.samples[i] = static_cast<std::uint32_t>(samples);
        work.rays[i] = samples + counts.shadow + counts.mirror + counts.transmitted;
    }
    return work;
}

template PixelWork pixel_work<float>(const Scene&, const Rect&, const StopFlag&);
template PixelWork pixel_work<double>(const Scene&, const Rect&, const StopFlag&);

}  // namespace rt
