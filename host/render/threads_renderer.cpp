// SPDX-License-Identifier: Apache-2.0
#include "host/render/threads_renderer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "host/base/memory.h"
#include "host/base/parallel.h"
#include "host/render/tile_rounds.h"

namespace rt {

namespace {

/// The rays that kernels count, plus the primary rays.
template <typename Counts>
RayCounts rays_of(const Counts& counts, std::int64_t primary) {
    return {static_cast<std::uint64_t>(primary) + counts.primary, counts.shadow, counts.mirror,
            counts.transmitted};
}

template <typename T>
class ThreadsRenderer : public Renderer<T> {
   public:
    ThreadsRenderer(const FlatScene<T>& scene, const ThreadsOptions& options)
        : options_(options),
          kernels_(native_kernels_for(scene, options)),
          view_(native_view(scene)) {}

    /// In rounds, the margin of a larger tile is a smaller part of it, but each thread should have
    /// a few tiles. Kernels count the numbers in a tile's sample buffers in an Index.
    TileSizes tile_sizes(int film_width) const override {
        if (in_rounds()) {
            const int threads = thread_count(options_, samples());
            const int side = film_width >= 340 * std::sqrt(threads) ? 128 : 64;  // 7 tiles a thread
            return {{0, 0, side, side}, 1 << 20};
        }
        TileSizes sizes{{0, 0, 32, 32}};
        if (options_.schedule == Schedule::buffers) {
            sizes.most_pixels = std::numeric_limits<Index>::max() / (3 * samples());
        }
        return sizes;
    }

    void render(TileQueue& queue, const Rect& region, Film<T>& film) override {
        if (options_.schedule == Schedule::buffers && !in_rounds()) {
            render_buffers(queue, region, film);
        } else {
            render_tiles(queue, region, film);
        }
    }

    RendererTimes times() const override { return times_; }

   private:
    using Index = typename Flat<T>::Index;
    using FlatTile = typename Flat<T>::Tile;
    using FlatCounts = typename Flat<T>::RayCounts;

    /// The packets of a launch, in rows over a tile.
    struct PacketGrid {
        Index across, down;

        PacketGrid(const FlatTile& tile, const PacketShape& shape)
            : across((tile.width + shape.width - 1) / shape.width),
              down((tile.height + shape.height - 1) / shape.height) {}
    };

    int samples() const { return static_cast<int>(view_.params.samples); }
    bool in_rounds() const { return renders_in_rounds(view_.params); }

    /// Calls work(first, end) for each row of packets; false if the queue was stopped meanwhile.
    template <typename Work>
    bool for_each_row(const PacketGrid& grid, const TileQueue& queue, const Work& work) const {
        for (Index row = 0; row < grid.down; ++row) {
            if (queue.stopped()) return false;
            work(row * grid.across, (row + 1) * grid.across);
        }
        return true;
    }

    void render_tiles(TileQueue& queue, const Rect& region, Film<T>& film) {
        const Stopwatch watch;
        std::atomic<std::int64_t> finished = 0;
        run_on_threads(thread_count(options_, samples()), [&](int) {
            std::vector<T> planes;
            while (const auto rect = queue.next()) {
                FlatCounts counts{};
                if (!render_tile(flat_tile<T>(*rect, region), queue, planes, counts, film)) return;
                queue.add_rays(rays_of(counts, rect->pixels() * samples()));
                queue.finish(*rect);
                finished += rect->pixels();
            }
        });
        times_.pixels += finished;
        times_.trace += watch.seconds();
    }

    /// False if stopped before its end, like for_each_row.
    bool render_tile(const FlatTile& tile, const TileQueue& queue, std::vector<T>& planes,
                     FlatCounts& counts, Film<T>& film) const {
        T* const to = film.rgb.data();
        if (in_rounds()) {
            return render_tile_in_rounds(kernels_, view_, tile, planes, to, counts,
                                         [&queue] { return queue.stopped(); });
        }
        const PacketGrid grid(tile, packet_shape(kernels_.lanes, samples()));
        return for_each_row(grid, queue, [&](Index first, Index end) {
            kernels_.render_pixels(to, &counts, &view_, &tile, first, end);
        });
    }

    /// The paper's schedule: a thread renders whole sample buffers, which are averaged at the end.
    /// A tile is finished once every buffer has it. Its parts of all buffers are contiguous.
    void render_buffers(TileQueue& queue, const Rect& region, Film<T>& film) {
        Stopwatch watch;
        const auto all = static_cast<std::size_t>(samples());
        check_memory(all * film.rgb.size() * sizeof(T), "a buffer for each sample",
                     "use --schedule tiles or fewer samples");
        std::vector<T> buffers(all * film.rgb.size());
        const std::vector<Rect>& tiles = queue.tiles();
        std::vector<std::size_t> begins;
        for (std::size_t at = 0; const Rect& tile : tiles) {
            begins.push_back(at);
            at += all * 3 * static_cast<std::size_t>(tile.pixels());
        }
        std::vector<std::atomic<int>> missing(tiles.size());
        for (auto& count : missing) count = samples();
        std::atomic<int> next_buffer = 0;
        run_on_threads(thread_count(options_, samples()), [&](int) {
            for (int k = next_buffer++; k < samples(); k = next_buffer++) {
                for (std::size_t i = 0; i < tiles.size() && !queue.stopped(); ++i) {
                    if (!render_sample(tiles[i], k, &buffers[begins[i]], queue, region)) break;
                    if (--missing[i] == 0) queue.finish(tiles[i]);
                }
            }
        });
        times_.trace = watch.lap();
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            if (missing[i] == 0) average(tiles[i], &buffers[begins[i]], region, film);
        }
        times_.resolve = watch.lap();
    }

    /// Renders sample k of a tile's pixels; false if stopped before the last.
    bool render_sample(const Rect& rect, Index k, T* buffers, TileQueue& queue,
                       const Rect& region) const {
        const FlatTile tile = flat_tile<T>(rect, region);
        const PacketGrid grid(tile, packet_shape(kernels_.lanes, 1));
        const Index before = k * grid.across * grid.down;
        FlatCounts counts{};
        const bool is_done = for_each_row(grid, queue, [&](Index first, Index end) {
            kernels_.render_samples(buffers, &counts, &view_, &tile, before + first, before + end);
        });
        if (is_done) queue.add_rays(rays_of(counts, rect.pixels()));
        return is_done;
    }

    void average(const Rect& rect, const T* buffers, const Rect& region, Film<T>& film) const {
        const FlatTile tile = flat_tile<T>(rect, region);
        const PacketGrid grid(tile, packet_shape(kernels_.lanes, 1));
        kernels_.resolve_samples(film.rgb.data(), buffers, &view_.params, &tile, 0,
                                 grid.across * grid.down);
    }

    const ThreadsOptions options_;
    const NativeKernels<T>& kernels_;
    const NativeView<T> view_;
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
const NativeKernels<T>& native_kernels_for(const FlatScene<T>& scene,
                                           const ThreadsOptions& options) {
    KernelChoice choice = options.kernels;
    choice.features = scene.features | choice.features;
    const bool any_samples = choice.any_samples || options.kernels.features.all();
    return choose_native<T>(choice, any_samples ? 0 : static_cast<int>(scene.params.samples));
}

template <typename T>
std::unique_ptr<Renderer<T>> make_threads_renderer(const FlatScene<T>& scene,
                                                   const ThreadsOptions& options) {
    return std::make_unique<ThreadsRenderer<T>>(scene, options);
}

template <typename T>
RayTracer<T> make_threads_ray_tracer(const FlatScene<T>& scene, const ThreadsOptions& options) {
    KernelChoice choice = options.kernels;
    choice.features = every_feature;
    const NativeKernels<T>& kernels = choose_native<T>(choice, 0);
    const int threads = thread_count({options.threads}, 1);
    return [&kernels, threads, view = native_view(scene)](auto queries, auto answers) {
        constexpr std::size_t run = 4096;
        for_each_run(answers.size(), run, threads, [&](std::size_t first, std::size_t last) {
            const auto count = static_cast<typename Flat<T>::Index>(last - first);
            kernels.trace_rays(&answers[first], &queries[first], &view, count, 0,
                               (count + kernels.lanes - 1) / kernels.lanes);
        });
    };
}

template RayTracer<float> make_threads_ray_tracer(const FlatScene<float>&, const ThreadsOptions&);
template RayTracer<double> make_threads_ray_tracer(const FlatScene<double>&, const ThreadsOptions&);
template const NativeKernels<float>& native_kernels_for(const FlatScene<float>&,
                                                        const ThreadsOptions&);
template const NativeKernels<double>& native_kernels_for(const FlatScene<double>&,
                                                         const ThreadsOptions&);
template std::unique_ptr<Renderer<float>> make_threads_renderer(const FlatScene<float>&,
                                                                const ThreadsOptions&);
template std::unique_ptr<Renderer<double>> make_threads_renderer(const FlatScene<double>&,
                                                                 const ThreadsOptions&);

}  // namespace rt
