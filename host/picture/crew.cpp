// SPDX-License-Identifier: Apache-2.0
#include "host/picture/crew.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <utility>

#include "host/base/error.h"
#include "host/base/parallel.h"
#include "host/base/text.h"
#include "host/opencl/cl_renderer.h"
#include "host/render/threads_renderer.h"
#include "host/render/tile_rounds.h"

namespace rt {

std::string joined_names(const std::vector<DeviceChoice>& devices) {
    std::string names;
    for (const DeviceChoice& choice : devices) {
        names +=
            (names.empty() ? "" : " + ") + (choice.use_threads ? "threads" : choice.device.name);
    }
    return names;
}

std::string inexact_names(const std::vector<DeviceChoice>& devices, Precision precision) {
    std::string names;
    for (const DeviceChoice& choice : devices) {
        if (!choice.is_exact(precision)) names += choice.device.name + "\n";
    }
    return names;
}

void warn_of_ignored_settings(const DeviceChoice& choice, const RenderSettings& settings,
                              const AaMode& aa, const RenderEvents& events) {
    const auto warn = [&](bool is_given, const std::string& option, const std::string& device) {
        if (is_given && events.message) events.message(option + " has no effect on " + device);
    };
    if (choice.use_threads) {
        warn(settings.schedule != Schedule::tiles && !aa.fixed_samples(), "--schedule",
             to_string(aa));
        warn(settings.kernels.launch != Launch::automatic, "--launch", "threads");
        warn(settings.math == Math::fast, "--math fast", "threads");
        warn(!build_extras().options.empty(), "--cl-options", "threads");
        warn(!build_extras().folder.empty(), "--save-kernels", "threads");
        if (std::max(choice.threads, settings.threads) > available_cores() && events.message) {
            events.message("more threads than the " + counted(available_cores(), "core") +
                           " available here; they take turns");
        }
        return;
    }
    warn(settings.schedule != Schedule::tiles, "--schedule", "OpenCL devices");
    warn(!settings.kernels.isa.empty(), "--isa", "OpenCL devices");
    if (!choice.failure.empty()) return;
    const bool is_pocl = choice.device.platform == pocl_platform;
    warn(settings.threads > 0 && !is_pocl, "--threads", choice.device.name);
    if (settings.math == Math::strict && !choice.is_exact(settings.precision) && events.detail) {
        events.detail(choice.device.name +
                      " does not guarantee exact rounding in float, so its pictures may differ in "
                      "a few bits");
    }
}

template <typename T>
std::vector<CrewMember<T>> CrewMaker<T>::members(const std::vector<DeviceChoice>& devices) const {
    const bool is_alone = devices.size() == 1;
    const bool is_whole = is_alone && aa.fixed_samples();
    std::vector<CrewMember<T>> members;
    for (const DeviceChoice& choice : devices) {
        if (choice.use_threads) {
            members.push_back(
                threads_member({choice.threads > 0 ? choice.threads : settings.threads,
                                is_whole ? settings.schedule : Schedule::tiles, settings.kernels}));
        } else {
            members.push_back(device_member(choice.device, is_alone));
            members.back().failure = choice.failure;
        }
    }
    return members;
}

template <typename T>
CrewMember<T> CrewMaker<T>::threads_member(const ThreadsOptions& options) const {
    const auto make = [scene = scene, options] {
        return make_threads_renderer<T>(*scene, options);
    };
    const TileSizes tiles = make()->tile_sizes(static_cast<int>(scene->params.width));
    CrewMember<T> member{"threads", tiles, make, {}};
    const NativeKernels<T>& kernels = native_kernels_for(*scene, options);
    member.stats.name = member.name;
    member.stats.lanes = kernels.lanes;
    member.stats.isa = kernels.isa;
    member.stats.kernels = kernels.features;
    member.stats.threads = thread_count(options, aa.samples());
    member.stats.schedule = to_string(options.schedule);
    return member;
}

template <typename T>
CrewMember<T> CrewMaker<T>::device_member(const ClDevice& device, bool is_alone) const {
    ClOptions options;
    options.kernels = settings.kernels;
    options.math = settings.math;
    options.shares_film = !is_alone;
    options.open_devices = open;
    const TileSizes tiles =
        cl_tile_sizes<T>(scene->params, device, options, static_cast<int>(scene->params.width));
    CrewMember<T> member{device.name, tiles, {}, {}};
    member.make = [scene = scene, device, options, loaded = loaded] {
        auto renderer = make_cl_renderer<T>(*scene, device, options);
        if (loaded) loaded();
        return renderer;
    };
    if (settings.self_test && settings.math == Math::strict) {
        member.test = [scene = scene, device, isa = settings.kernels.isa](Renderer<T>& renderer) {
            self_test(renderer, device, *scene, isa);
        };
    }
    const bool by_samples = launches_samples(settings.kernels.launch, device, !aa.fixed_samples());
    member.stats.name = member.name;
    member.stats.platform = device.platform;
    member.stats.driver = device.driver;
    member.stats.launch = by_samples ? "sample" : "pixel";
    member.stats.lanes = packet_lanes<T>(settings.kernels.lanes, device);
    member.stats.kernels = scene->features | settings.kernels.features;
    return member;
}

template struct CrewMaker<float>;
template struct CrewMaker<double>;

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
        throw Error(
            ExitCode::device,
            fmt::format("{} fails its self-test: {}; {}, or use --device threads", device.name, why,
                        advice_on_other_bits(device.is_exact(precision_of<T>))));
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
