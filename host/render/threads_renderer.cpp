// SPDX-License-Identifier: Apache-2.0
#include "host/render/threads_renderer.h"

#include <algorithm>
#include <atomic>

#include "host/memory_limit.h"
#include "host/parallel.h"
#include "host/render/stopwatch.h"
#include "host/trace/whitted.h"

namespace rt {

namespace {

template <typename T>
void store3(std::vector<T>& rgb, typename Flat<T>::Index pixel, const Vec3<T>& color) {
    const std::size_t at = 3 * static_cast<std::size_t>(pixel);
    rgb[at] = color.x;
    rgb[at + 1] = color.y;
    rgb[at + 2] = color.z;
}

/// Calls body(x, y, film index) for each pixel of the tile, with y counted from the bottom.
template <typename T, typename Body>
void for_each_pixel(const typename Flat<T>::Tile& tile, typename Flat<T>::Index picture_height,
                    const Body& body) {
    using Index = typename Flat<T>::Index;
    for (Index row = 0; row < tile.height; ++row) {
        for (Index column = 0; column < tile.width; ++column) {
            body(tile.x + column, picture_height - 1 - (tile.y + row),
                 tile.first + row * tile.film_width + column);
        }
    }
}

/// Twin of trace_pixel in kernels/render.cl.
template <typename T>
Vec3<T> trace_pixel(const trace::SceneView<T>& scene, typename Flat<T>::Index x,
                    typename Flat<T>::Index y, RayCounts& counts) {
    Vec3<T> sum(T(0));
    T total = 0;
    for (typename Flat<T>::Index k = 0; k < scene.frame.samples; ++k) {
        const T weight = trace::sample_weight<T>(scene.frame, x, y, k);
        sum = trace::add_scaled(sum, weight, trace::trace_sample(scene, x, y, k, counts));
        total += weight;
    }
    return sum / total;
}

template <typename T>
RayCounts render_pixels(const trace::SceneView<T>& scene, const typename Flat<T>::Tile& tile,
                        std::vector<T>& rgb) {
    using Index = typename Flat<T>::Index;
    RayCounts counts;
    for_each_pixel<T>(tile, scene.frame.height, [&](Index x, Index y, Index pixel) {
        store3(rgb, pixel, trace_pixel(scene, x, y, counts));
    });
    return counts;
}

/// Twin of render_listed in kernels/render.cl.
template <typename T>
RayCounts refine_pixels(const trace::SceneView<T>& scene, std::span<const std::int32_t> pixels,
                        const Rect& region, std::vector<T>& rgb) {
    RayCounts counts;
    for (const std::int32_t pixel : pixels) {
        const int column = pixel % region.width, row = pixel / region.width;
        store3(rgb, typename Flat<T>::Index{pixel},
               trace_pixel<T>(scene, region.x + column, scene.frame.height - 1 - (region.y + row),
                              counts));
    }
    return counts;
}

/// One sample of each of the tile's pixels, into a buffer of its own.
template <typename T>
RayCounts render_sample(const trace::SceneView<T>& scene, const typename Flat<T>::Tile& tile,
                        typename Flat<T>::Index k, std::vector<T>& rgb) {
    using Index = typename Flat<T>::Index;
    RayCounts counts;
    for_each_pixel<T>(tile, scene.frame.height, [&](Index x, Index y, Index pixel) {
        store3(rgb, pixel, trace::trace_sample(scene, x, y, k, counts));
    });
    return counts;
}

/// Pixels that a thread takes at once when refining.
constexpr std::size_t refine_run = 64;

template <typename T>
class ThreadsRenderer : public Renderer<T> {
   public:
    ThreadsRenderer(const FlatScene<T>& scene, const ThreadsOptions& options)
        : scene_(scene), options_(options) {}

    Rect tile_size(int) const override { return {0, 0, 32, 32}; }

    void render(TileQueue& queue, const Rect& region, Film<T>& film) override {
        if (options_.schedule == Schedule::buffers) {
            render_buffers(queue, region, film);
        } else {
            render_tiles(queue, region, film);
        }
    }

    /// Threads take runs of pixels from a shared counter.
    void refine(std::span<const std::int32_t> pixels, int grid, TileQueue& queue,
                const Rect& region, Film<T>& film) override {
        const Stopwatch watch;
        trace::SceneView<T> view = trace::view_of(scene_);
        view.frame.grid = grid;
        view.frame.samples = grid * grid;
        std::atomic<std::size_t> next = 0;
        run_on_threads(thread_count({options_.threads, Schedule::tiles}, 1), [&](int) {
            for (;;) {
                const std::size_t at = next.fetch_add(refine_run);
                if (at >= pixels.size()) return;
                queue.add_rays(refine_pixels(
                    view, pixels.subspan(at, std::min(refine_run, pixels.size() - at)), region,
                    film.rgb));
            }
        });
        times_.trace += watch.seconds();
    }

    RendererTimes times() const override { return times_; }

   private:
    int samples() const { return static_cast<int>(scene_.frame.samples); }

    void render_tiles(TileQueue& queue, const Rect& region, Film<T>& film) {
        const Stopwatch watch;
        const trace::SceneView<T> view = trace::view_of(scene_);
        run_on_threads(thread_count(options_, samples()), [&](int) {
            while (const auto tile = queue.next()) {
                queue.add_rays(render_pixels<T>(view, flat_tile<T>(*tile, region), film.rgb));
                queue.finish(*tile);
            }
        });
        times_.trace = watch.seconds();
    }

    /// The paper's schedule. A tile is finished once every buffer has it.
    void render_buffers(TileQueue& queue, const Rect& region, Film<T>& film) {
        Stopwatch watch;
        const trace::SceneView<T> view = trace::view_of(scene_);
        check_memory(static_cast<std::uint64_t>(samples()) * film.rgb.size() * sizeof(T),
                     "a buffer for each sample", "use --schedule tiles or fewer samples");
        std::vector<std::vector<T>> buffers(static_cast<std::size_t>(samples()),
                                            std::vector<T>(film.rgb.size()));
        std::vector<std::atomic<int>> missing(queue.tiles().size());
        for (auto& count : missing) count = samples();
        std::atomic<int> next_buffer = 0;
        run_on_threads(thread_count(options_, samples()), [&](int) {
            for (int k = next_buffer++; k < samples(); k = next_buffer++) {
                for (std::size_t i = 0; i < missing.size() && !queue.stopped(); ++i) {
                    const auto tile = flat_tile<T>(queue.tiles()[i], region);
                    queue.add_rays(
                        render_sample<T>(view, tile, k, buffers[static_cast<std::size_t>(k)]));
                    if (--missing[i] == 0) queue.finish(queue.tiles()[i]);
                }
            }
        });
        times_.trace = watch.lap();
        for (std::size_t i = 0; i < missing.size(); ++i) {
            if (missing[i] == 0) average(flat_tile<T>(queue.tiles()[i], region), buffers, film.rgb);
        }
        times_.resolve = watch.lap();
    }

    /// Twin of resolve_samples in kernels/render.cl.
    void average(const typename Flat<T>::Tile& tile, const std::vector<std::vector<T>>& buffers,
                 std::vector<T>& rgb) const {
        using Index = typename Flat<T>::Index;
        for_each_pixel<T>(tile, scene_.frame.height, [&](Index x, Index y, Index pixel) {
            const std::size_t at = 3 * static_cast<std::size_t>(pixel);
            Vec3<T> sum(T(0));
            T total = 0;
            for (std::size_t k = 0; k < buffers.size(); ++k) {
                const T weight = trace::sample_weight<T>(scene_.frame, x, y, static_cast<Index>(k));
                const Vec3<T> color(buffers[k][at], buffers[k][at + 1], buffers[k][at + 2]);
                sum = trace::add_scaled(sum, weight, color);
                total += weight;
            }
            store3(rgb, pixel, sum / total);
        });
    }

    const FlatScene<T>& scene_;
    const ThreadsOptions options_;
    RendererTimes times_;
};

}  // namespace

int thread_count(const ThreadsOptions& options, int samples) {
    if (options.schedule == Schedule::tiles) {
        return options.threads > 0 ? options.threads : available_cores();
    }
    return options.threads > 0 ? std::min(options.threads, samples) : samples;
}

template <typename T>
std::unique_ptr<Renderer<T>> make_threads_renderer(const FlatScene<T>& scene,
                                                   const ThreadsOptions& options) {
    return std::make_unique<ThreadsRenderer<T>>(scene, options);
}

template std::unique_ptr<Renderer<float>> make_threads_renderer(const FlatScene<float>&,
                                                                const ThreadsOptions&);
template std::unique_ptr<Renderer<double>> make_threads_renderer(const FlatScene<double>&,
                                                                 const ThreadsOptions&);

}  // namespace rt
