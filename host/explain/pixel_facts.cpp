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
/// samples beyond that at its center. With single rays, so that a work item has one pixel.
template <typename T>
class PixelCounter {
   public:
    using Counts = typename Flat<T>::RayCounts;

    PixelCounter(const FlatScene<T>& scene, const Rect& region)
        : kernels_(native_kernels_for(scene, single_rays())),
          view_(native_view(scene)),
          region_(region),
          counts_(static_cast<std::size_t>(region.pixels())) {}

    const Counts& operator[](std::size_t i) const { return counts_[i]; }
    std::uint64_t samples() const { return static_cast<std::uint64_t>(view_.params.samples); }

    void count(const Rect& rect) {
        const auto tile = flat_tile<T>(rect, rect);
        std::vector<T> film(3 * static_cast<std::size_t>(rect.pixels()));
        if (!renders_in_rounds(view_.params)) {
            each_item(rect, 0, [&](Counts& counts, Index item) {
                kernels_.render_pixels(film.data(), &counts, &view_, &tile, item, item + 1);
            });
            return;
        }
        std::vector<T> planes(plane_values(view_.params, tile, 1));
        const int margin = tile_margin(view_.params);
        each_item(rect, margin, [&](Counts& counts, Index item) {
            kernels_.render_centers(planes.data(), &counts, &view_, &tile, item, item + 1);
        });
        const auto render = round_kernel(kernels_, view_.params);
        for (int round = 0; round < margin; ++round) {
            each_item(rect, margin - 1 - round, [&](Counts& counts, Index item) {
                render(film.data(), &counts, &view_, &tile, planes.data(), round, item, item + 1);
            });
        }
    }

   private:
    using Index = typename Flat<T>::Index;

    static ThreadsOptions single_rays() {
        ThreadsOptions options;
        options.kernels.any_samples = true;
        options.kernels.lanes = 1;
        return options;
    }

    /// Calls work(counts, item) for each pixel of a rectangle and its margin.
    template <typename Work>
    void each_item(const Rect& rect, int margin, const Work& work) {
        Counts ignored{};
        Index item = 0;
        for (int y = rect.y - margin; y < rect.y + rect.height + margin; ++y) {
            for (int x = rect.x - margin; x < rect.x + rect.width + margin; ++x) {
                const bool is_inside = is_within({x, y, 1, 1}, rect);
                work(is_inside ? counts_[index_in(region_, x, y)] : ignored, item++);
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
    const std::vector<Rect> tiles = make_tiles(region, 64, 64);
    for_each_run(tiles.size(), 1, available_cores(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last && stop == 0; ++i) counter.count(tiles[i]);
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
