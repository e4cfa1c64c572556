// SPDX-License-Identifier: Apache-2.0
#include "host/picture/tile_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "host/error.h"
#include "host/render/picture_loop.h"
#include "host/render/threads_renderer.h"

namespace rt {

namespace {

constexpr double test_samples = 4096;
constexpr int largest_test = 32;

const StopFlag never_stopped = 0;

template <typename T>
std::unique_ptr<Renderer<T>> checking_renderer(const FlatScene<T>& scene, const std::string& isa) {
    ThreadsOptions options;
    options.isa = isa;
    return make_threads_renderer(scene, options);
}

template <typename T>
Film<T> rendered(Renderer<T>& renderer, const AaMode& aa, const Rect& region) {
    Film<T> film(region.width, region.height);
    TileQueue queue({region}, never_stopped);
    render_all(renderer, aa, queue, region, film);
    return film;
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

/// In the middle of the picture, with few samples.
template <typename T>
Rect test_tile(const Renderer<T>& device, const typename Flat<T>::LaunchParams& params) {
    const auto width = static_cast<int>(params.width), height = static_cast<int>(params.height);
    const auto pixels = std::min(test_samples / static_cast<double>(params.samples),
                                 static_cast<double>(device.most_tile_pixels()));
    const int side = std::clamp(static_cast<int>(std::sqrt(pixels)), 1, largest_test);
    const int across = std::min(side, width), down = std::min(side, height);
    return {(width - across) / 2, (height - down) / 2, across, down};
}

}  // namespace

template <typename T>
void self_test(Renderer<T>& device, const std::string& name, const FlatScene<T>& scene,
               const std::string& isa) {
    const Rect tile = test_tile(device, scene.params);
    const auto threads = checking_renderer(scene, isa);
    const std::size_t wrong =
        differing_pixels(rendered(device, AaMode{}, tile), rendered(*threads, AaMode{}, tile));
    if (wrong == 0) return;
    throw Error(ExitCode::device,
                fmt::format("{} fails its self-test: {} of {} pixels differ from what threads "
                            "compute; clear its kernel cache, update its driver, or use --device "
                            "threads",
                            name, wrong, tile.pixels()));
}

template <typename T>
TileCheck check_tiles(const FlatScene<T>& scene, const AaMode& aa, const std::string& isa,
                      const std::vector<Rect>& tiles, double share, const Rect& region,
                      const Film<T>& film) {
    const auto threads = checking_renderer(scene, isa);
    const auto width = static_cast<int>(scene.params.width);
    const auto height = static_cast<int>(scene.params.height);
    TileCheck check;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const auto steps = [&](std::size_t n) { return std::ceil(share * static_cast<double>(n)); };
        if (steps(i + 1) == steps(i)) continue;
        const Rect& tile = tiles[i];
        const Rect around = region_to_render(aa, tile, width, height);
        const Film<T> again = rendered(*threads, aa, around);
        ++check.tiles;
        if (differing_pixels(part_of(again, around, tile), part_of(film, region, tile)) != 0) {
            ++check.wrong_tiles;
        }
    }
    return check;
}

std::string impossible_rays(const RayCounts& rays, std::size_t lights, int max_bounces,
                            bool has_glass) {
    const double bounces = max_bounces;
    const double most = has_glass ? std::exp2(bounces + 1) - 2 : bounces;
    const std::uint64_t secondary = rays.mirror + rays.transmitted;
    if (static_cast<double>(secondary) > most * static_cast<double>(rays.primary)) {
        return fmt::format("{} mirror and refracted rays of {} eye rays", secondary, rays.primary);
    }
    const double surfaces = static_cast<double>(rays.primary) + static_cast<double>(secondary);
    if (static_cast<double>(rays.shadow) > surfaces * static_cast<double>(lights)) {
        return fmt::format("{} shadow rays of {} others", rays.shadow, rays.primary + secondary);
    }
    return "";
}

template void self_test(Renderer<float>&, const std::string&, const FlatScene<float>&,
                        const std::string&);
template void self_test(Renderer<double>&, const std::string&, const FlatScene<double>&,
                        const std::string&);
template TileCheck check_tiles(const FlatScene<float>&, const AaMode&, const std::string&,
                               const std::vector<Rect>&, double, const Rect&, const Film<float>&);
template TileCheck check_tiles(const FlatScene<double>&, const AaMode&, const std::string&,
                               const std::vector<Rect>&, double, const Rect&, const Film<double>&);

}  // namespace rt
