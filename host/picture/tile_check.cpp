// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>
#include <utility>

#include "host/base/error.h"
#include "host/picture/crew.h"
#include "host/render/threads_renderer.h"
#include "host/render/tile_rounds.h"

namespace rt {

namespace {

constexpr int strips = 4;
constexpr double strip_samples = 8192;

template <typename T>
std::unique_ptr<Renderer<T>> checking_renderer(const FlatScene<T>& scene, const std::string& isa) {
    ThreadsOptions options;
    options.kernels.isa = isa;
    return make_threads_renderer(scene, options);
}

/// Compares bits: a NaN equals itself, and 0 is not -0.
template <typename T>
std::size_t differing_pixels(const Film<T>& a, const Film<T>& b) {
    std::size_t count = 0;
    for (std::size_t at = 0; at < a.rgb.size(); at += 3) {
        if (std::memcmp(&a.rgb[at], &b.rgb[at], 3 * sizeof(T)) != 0) ++count;
    }
    return count;
}

/// Narrow strips across the whole picture, or as much of it as has few samples: they meet more of a
/// scene than a square does.
template <typename T>
std::vector<Rect> test_strips(const Renderer<T>& device,
                              const typename Flat<T>::LaunchParams& params) {
    const auto width = static_cast<int>(params.width), height = static_cast<int>(params.height);
    const double samples =
        renders_in_rounds(params) ? round_samples_guess : static_cast<double>(params.samples);
    const int down = std::clamp(static_cast<int>(4 / std::sqrt(samples)), 1, height);
    const double pixels = std::min(strip_samples / samples,
                                   static_cast<double>(device.tile_sizes(width).most_pixels));
    const int across = std::clamp(static_cast<int>(pixels) / down, 1, width);
    std::vector<Rect> tiles;
    for (int i = 0; i < strips; ++i) {
        const int y = (2 * i + 1) * height / (2 * strips);
        tiles.push_back({(width - across) / 2, std::min(y, height - down), across, down});
    }
    return tiles;
}

/// A share of the numbers below n, at least one, spread evenly; other ones each time.
std::vector<std::size_t> sample(std::size_t n, double share) {
    const auto count = static_cast<std::size_t>(std::ceil(share * static_cast<double>(n)));
    std::random_device random;
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t first = i * n / count, end = (i + 1) * n / count;
        numbers.push_back(std::uniform_int_distribution<std::size_t>(first, end - 1)(random));
    }
    return numbers;
}

}  // namespace

template <typename T>
void self_test(Renderer<T>& renderer, const ClDevice& device, const FlatScene<T>& scene,
               const std::string& isa) {
    const auto threads = checking_renderer(scene, isa);
    for (const Rect& strip : test_strips(renderer, scene.params)) {
        const auto [film, rays] = render_region(renderer, strip);
        const auto [right, right_rays] = render_region(*threads, strip);
        const std::size_t wrong = differing_pixels(film, right);
        if (wrong == 0 && rays == right_rays) continue;
        const std::string why =
            wrong > 0
                ? fmt::format("{} of {} pixels differ from those of threads", wrong, strip.pixels())
                : fmt::format("it counts {} rays, threads {}", rays.total(), right_rays.total());
        throw Error(ExitCode::device,
                    fmt::format("{} fails its self-test: {}; {}, or use --device threads",
                                device.name, why, device.advice(precision_of<T>)));
    }
}

template <typename T>
TileCheck check_tiles(const FlatScene<T>& scene, const std::string& isa,
                      const std::vector<Rect>& tiles, double share, const Rect& region,
                      const Film<T>& film, const StopFlag& stop) {
    const auto threads = checking_renderer(scene, isa);
    TileCheck check;
    for (const std::size_t i : sample(tiles.size(), share)) {
        if (stop != 0) break;
        const Rect& tile = tiles[i];
        const Film<T> again = render_region(*threads, tile).first;
        ++check.tiles;
        if (differing_pixels(again, part_of(film, region, tile)) != 0) ++check.wrong_tiles;
    }
    return check;
}

template void self_test(Renderer<float>&, const ClDevice&, const FlatScene<float>&,
                        const std::string&);
template void self_test(Renderer<double>&, const ClDevice&, const FlatScene<double>&,
                        const std::string&);
template TileCheck check_tiles(const FlatScene<float>&, const std::string&,
                               const std::vector<Rect>&, double, const Rect&, const Film<float>&,
                               const StopFlag&);
template TileCheck check_tiles(const FlatScene<double>&, const std::string&,
                               const std::vector<Rect>&, double, const Rect&, const Film<double>&,
                               const StopFlag&);

}  // namespace rt
