// SPDX-License-Identifier: Apache-2.0
#include "host/explain/pixel_facts.h"

#include <array>
#include <cstddef>

#include "host/base/parallel.h"
#include "host/explain/ray_tree.h"
#include "host/flatten/view_frame.h"
#include "host/render/edge_tile.h"
#include "host/render/native_kernels.h"
#include "host/render/packet_shape.h"
#include "host/render/picture_loop.h"

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

/// Samples per side with which an adaptive picture refines each pixel of the region; 0 if it does
/// not.
template <typename T>
std::vector<int> refined_grids(const FlatScene<T>& scene, const AaMode& aa, const Rect& region,
                               const StopFlag& stop) {
    std::vector<int> grids(static_cast<std::size_t>(region.pixels()), 0);
    if (!aa.refines()) return grids;
    const Rect film_rect = region_to_render(aa, region, static_cast<int>(scene.params.width),
                                            static_cast<int>(scene.params.height));
    RefineEvents<T> events;
    events.planned = [&](int, std::vector<Refinement>& plan, Film<T>&) {
        for (const Refinement& step : plan) {
            for (const std::int32_t pixel : step.pixels) {
                const int x = film_rect.x + pixel % film_rect.width - region.x;
                const int y = film_rect.y + pixel / film_rect.width - region.y;
                if (x < 0 || y < 0 || x >= region.width || y >= region.height) continue;
                grids[static_cast<std::size_t>(y) * region.width + x] = step.grid;
            }
        }
    };
    const auto renderer = make_threads_renderer(scene, {});
    Film<T> film(film_rect.width, film_rect.height);
    const Rect tile = renderer->tile_size(film_rect.width);
    TileQueue queue(make_tiles(film_rect, tile.width, tile.height), stop);
    render_all(*renderer, aa, queue, film_rect, film, events);
    return grids;
}

template <typename Counts>
std::uint64_t secondary(const Counts& counts) {
    return counts.shadow + counts.mirror + counts.transmitted;
}

/// Renders pixels one at a time.
template <typename T>
class PixelCounter {
   public:
    explicit PixelCounter(const FlatScene<T>& scene)
        : kernels_(native_kernels_for(scene, any_samples())), view_(native_view(scene)) {}

    std::uint64_t samples() const { return static_cast<std::uint64_t>(view_.params.samples); }

    /// Rays beyond an eye ray for each sample: for the pixel's samples, or for a grid of them. In
    /// an edges mode `primary` counts the samples at an edge.
    typename Flat<T>::RayCounts rays(int x, int y, int grid = 0) const {
        std::array<T, 3> color;
        const auto tile = flat_tile<T>({x, y, 1, 1}, {x, y, 1, 1});
        typename Flat<T>::RayCounts counts{};
        if (view_.params.tolerance > 0) {
            std::vector<T> planes;
            render_edge_tile(kernels_, view_, tile, planes, color.data(), counts,
                             [] { return false; });
        } else if (grid == 0) {
            kernels_.render_pixels(color.data(), &counts, &view_, &tile, 0, 1);
        } else {
            NativeView<T> view = view_;
            view.params.grid = grid;
            view.params.samples = grid * grid;
            const std::int32_t pixel = 0;
            kernels_.render_list(color.data(), &counts, &view, &tile, &pixel, 0, 1);
        }
        return counts;
    }

   private:
    static ThreadsOptions any_samples() {
        ThreadsOptions options;
        options.kernels.any_samples = true;
        return options;
    }

    const NativeKernels<T>& kernels_;
    const NativeView<T> view_;
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
    const std::vector<int> grids = refined_grids(flat, scene.aa, region, stop);
    const PixelCounter<T> counter(flat);
    PixelWork work{std::vector<std::uint32_t>(grids.size()),
                   std::vector<std::uint64_t>(grids.size())};
    for_each_pixel(region, stop, [&](std::size_t i, int x, int y) {
        const auto refined = static_cast<std::uint64_t>(grids[i] * grids[i]);
        const auto counts = counter.rays(x, y);
        const std::uint64_t samples = counter.samples() + refined + counts.primary;
        work.samples[i] = static_cast<std::uint32_t>(samples);
        work.rays[i] = samples + secondary(counts);
        if (refined > 0) work.rays[i] += secondary(counter.rays(x, y, grids[i]));
    });
    return work;
}

template PixelWork pixel_work<float>(const Scene&, const Rect&, const StopFlag&);
template PixelWork pixel_work<double>(const Scene&, const Rect&, const StopFlag&);

}  // namespace rt
