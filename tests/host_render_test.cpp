// SPDX-License-Identifier: Apache-2.0
//
// The small parts around the tracer: tiles, threads, device choice, film, image error, statistics.
#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>

#include "host/base/error.h"
#include "host/base/parallel.h"
#include "host/flatten/flat_scene.h"
#include "host/image/image_error.h"
#include "host/opencl/cl_renderer.h"
#include "host/opencl/devices.h"
#include "host/render/film.h"
#include "host/render/threads_renderer.h"
#include "host/render/tile_queue.h"
#include "host/scene/aa_mode.h"
#include "tests/refusals.h"

namespace rt::this_file {
namespace {

TEST(MakeTiles, CoverEveryPixelOnce) {
    const Rect region{3, 5, 100, 37};
    std::set<std::pair<int, int>> pixels;
    for (const Rect& tile : make_tiles(region, 13, 7)) {
        EXPECT_LE(tile.width, 13);
        EXPECT_LE(tile.height, 7);
        for (int y = tile.y; y < tile.y + tile.height; ++y) {
            for (int x = tile.x; x < tile.x + tile.width; ++x) {
                EXPECT_TRUE(pixels.insert({x, y}).second);
            }
        }
    }
    EXPECT_EQ(pixels.size(), 3700u);
    EXPECT_EQ(*pixels.begin(), std::make_pair(3, 5));
    EXPECT_EQ(*pixels.rbegin(), std::make_pair(102, 41));
}

TEST(MakeTiles, CoverAColumnAndARowOfOnePixel) {
    std::int64_t pixels = 0;
    for (const Rect& tile : make_tiles({0, 0, 27, 15}, 13, 7)) pixels += tile.pixels();
    EXPECT_EQ(pixels, 27 * 15);
}

TEST(TileQueue, HandsOutEveryTileOnceToManyThreads) {
    static const StopFlag go = 0;
    TileQueue queue(make_tiles({0, 0, 640, 480}, 8, 8), go);
    std::atomic<int> taken = 0;
    run_on_threads(8, [&](int) {
        while (const auto tile = queue.next()) {
            ++taken;
            queue.add_rays({1, 2, 3});
            queue.finish(*tile);
        }
    });
    EXPECT_EQ(taken, 80 * 60);
    EXPECT_EQ(queue.tiles_finished(), queue.tiles().size());
    EXPECT_EQ(queue.fraction_finished(), 1.0);
    EXPECT_EQ(queue.rays().total(), 6u * 4800);
}

/// The runs of a queue whose launches hold at most most_pixels pixels.
std::vector<Rect> runs_of(const Rect& region, int tile_width, int tile_height,
                          std::int64_t most_pixels) {
    static const StopFlag go = 0;
    TileQueue queue(make_tiles(region, tile_width, tile_height), go);
    std::vector<Rect> runs;
    while (const auto run =
               queue.next_run([&](const Rect& rect) { return rect.pixels() <= most_pixels; })) {
        runs.push_back(run->whole);
        queue.finish(*run);
    }
    EXPECT_EQ(queue.tiles_finished(), queue.tiles().size());
    EXPECT_EQ(queue.fraction_finished(), 1.0);
    return runs;
}

TEST(TileQueue, RunsAreTheLargestRectanglesOfTilesInTheirOrder) {
    // Whole rows of tiles, the last one lower.
    EXPECT_EQ(runs_of({5, 7, 100, 35}, 100, 10, 2000),
              (std::vector<Rect>{{5, 7, 100, 20}, {5, 27, 100, 15}}));
    // Two tiles of a row, then its third; the same for the next row.
    EXPECT_EQ(
        runs_of({0, 0, 100, 20}, 40, 10, 800),
        (std::vector<Rect>{{0, 0, 80, 10}, {80, 0, 20, 10}, {0, 10, 80, 10}, {80, 10, 20, 10}}));
    EXPECT_EQ(runs_of({0, 0, 64, 64}, 8, 8, 1 << 20), (std::vector<Rect>{{0, 0, 64, 64}}));
    EXPECT_EQ(runs_of({0, 0, 64, 64}, 8, 8, 1).size(), 64u);
}

TEST(LaunchPacer, SettlesOnLaunchesOfATenthOfASecond) {
    LaunchPacer pacer(1000, 1 << 30);
    EXPECT_EQ(pacer.samples(), 1000);
    for (int i = 0; i < 6; ++i) {
        const auto samples = pacer.samples();
        pacer.note(samples, static_cast<double>(samples) / 5e6);
    }
    EXPECT_EQ(pacer.samples(), 500000);
    pacer.note(500000, 0.4);  // four times the work from here
    EXPECT_EQ(pacer.samples(), 125000);
}

TEST(LaunchPacer, GrowsEightfoldAtMostAndKeepsItsBounds) {
    LaunchPacer pacer(1000, 20000);
    pacer.note(1000, 1e-9);
    EXPECT_EQ(pacer.samples(), 8000);
    pacer.note(8000, 0);
    EXPECT_EQ(pacer.samples(), 20000);
    pacer.note(1, 1e6);
    EXPECT_EQ(pacer.samples(), 1);
    EXPECT_EQ(LaunchPacer(1000, 10).samples(), 10);
    LaunchPacer wide(1000, 20000, 500);
    wide.note(1000, 1e6);
    EXPECT_EQ(wide.samples(), 500);
    EXPECT_EQ(LaunchPacer(1000, 10, 500).samples(), 10);
}

TEST(TileQueue, GivesNothingOnceStopped) {
    static StopFlag stop = 0;
    TileQueue queue(make_tiles({0, 0, 64, 64}, 8, 8), stop);
    EXPECT_TRUE(queue.next().has_value());
    stop = 2;
    EXPECT_FALSE(queue.next().has_value());
    EXPECT_TRUE(queue.stopped());
}

TEST(RunOnThreads, RunsEachIndexOnceAndRethrows) {
    std::atomic<int> sum = 0;
    run_on_threads(16, [&](int i) { sum += i; });
    EXPECT_EQ(sum, 120);
    const auto fail = [](int i) {
        if (i == 3) throw Error(ExitCode::bug, "three");
    };
    EXPECT_THROW(run_on_threads(5, fail), Error);
}

TEST(RunOnThreads, LetsEachRunOnAnyCore) {
    const auto cores = [] {
        cpu_set_t mask;
        return sched_getaffinity(0, sizeof mask, &mask) == 0 ? CPU_COUNT(&mask) : -1;
    };
    run_on_threads(available_cores() + 1, [&](int) { EXPECT_EQ(cores(), available_cores()); });
    cpu_set_t before, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(sched_getcpu()), &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    run_on_threads(3, [&](int) { EXPECT_EQ(cores(), 1); });
    ASSERT_EQ(sched_setaffinity(0, sizeof before, &before), 0);
}

TEST(ThreadCount, BuffersNeverUseMoreThreadsThanSamples) {
    EXPECT_EQ(thread_count({0, Schedule::buffers}, 4), 4);
    EXPECT_EQ(thread_count({2, Schedule::buffers}, 4), 2);
    EXPECT_EQ(thread_count({9, Schedule::buffers}, 4), 4);
    EXPECT_EQ(thread_count({9, Schedule::tiles}, 4), 9);
    EXPECT_EQ(thread_count({0, Schedule::tiles}, 4), available_cores());
}

TEST(ThreadsRenderer, NumbersTheBuffersOfATileInAnIndex) {
    Scene scene;
    scene.aa = grid_aa(64);
    const FlatScene<float> flat = flatten<float>(scene);
    const auto renderer = make_threads_renderer(flat, {1, Schedule::buffers});
    const auto [best, most] = renderer->tile_sizes(500);
    EXPECT_LE(3 * 64 * 64 * most, std::numeric_limits<int>::max());
    EXPECT_GE(most, best.pixels());
}

ClDevice device(int index, int platform_index, const char* name, const char* platform, bool gpu) {
    ClDevice made;
    made.index = index;
    made.platform_index = platform_index;
    made.device_index = 0;
    made.name = name;
    made.platform = platform;
    made.kind = gpu ? "GPU" : "CPU";
    return made;
}

std::vector<ClDevice> three_devices() {
    return {device(0, 0, "pthread-cpu", "Portable Computing Language", false),
            device(1, 1, "Radeon Pro", "AMD Accelerated", true),
            device(2, 2, "Xeon", "Intel OpenCL", false)};
}

int chosen(const std::string& spec) { return choose_device(spec, {three_devices()}).device.index; }

ExitCode refusal(const std::string& spec, const std::vector<ClDevice>& devices) {
    return refusal_of([&] { choose_device(spec, {devices}); }).exit_code;
}

TEST(ChooseDevice, UnderstandsEverySpec) {
    EXPECT_EQ(chosen(""), 1);
    EXPECT_EQ(chosen("2"), 2);
    EXPECT_EQ(chosen("2:0"), 2);
    EXPECT_EQ(chosen("pocl"), 0);
    EXPECT_EQ(chosen("gpu"), 1);
    EXPECT_EQ(chosen("name:radeon"), 1);
    EXPECT_EQ(chosen("name:intel"), 2);
}

TEST(ChooseDevice, RefusesWhatFitsNoneOrSeveral) {
    EXPECT_EQ(refusal("cpu", three_devices()), ExitCode::usage);
    EXPECT_EQ(refusal("7", three_devices()), ExitCode::device);
    EXPECT_EQ(refusal("1:1", three_devices()), ExitCode::device);
    EXPECT_EQ(refusal("nonsense", three_devices()), ExitCode::usage);
    EXPECT_EQ(refusal("name:", three_devices()), ExitCode::usage);
    auto broken = three_devices();
    broken[1].unusable = "its driver has no compiler";
    EXPECT_EQ(refusal("gpu", broken), ExitCode::device);
}

TEST(ChooseDevice, AutoTakesAGpuElseThreads) {
    auto devices = three_devices();
    const auto gpu = std::find_if(devices.begin(), devices.end(),
                                  [](const ClDevice& device) { return device.is_gpu(); });
    EXPECT_FALSE(choose_device("auto", {devices}).use_threads);
    EXPECT_TRUE(choose_device("", {devices}).device.is_gpu());
    gpu->unusable = "its driver has no compiler";
    const DeviceChoice choice = choose_device("auto", {devices});
    EXPECT_TRUE(choice.use_threads);
    EXPECT_NE(choice.note.find("its driver has no compiler"), std::string::npos);
    devices.erase(gpu);
    EXPECT_TRUE(choose_device("auto", {devices}).use_threads);
}

TEST(NeedsOpencl, KnowsAGpuByItsDeviceFile) {
    const std::filesystem::path dev =
        std::filesystem::temp_directory_path() / ("dev-" + std::to_string(getpid()));
    std::filesystem::create_directories(dev / "dri");
    EXPECT_FALSE(gpu_may_be_here(dev));
    EXPECT_FALSE(gpu_may_be_here(dev / "missing"));
    std::ofstream(dev / "dri/card0") << "";
    EXPECT_FALSE(gpu_may_be_here(dev));
    std::ofstream(dev / "dri/renderD128") << "";
    EXPECT_TRUE(gpu_may_be_here(dev));
    std::filesystem::remove_all(dev);
    EXPECT_FALSE(needs_opencl("threads:3"));
    EXPECT_TRUE(needs_opencl("threads,pocl"));
}

TEST(ParseAaMode, RoundTripsAndRefuses) {
    for (const char* text :
         {"none", "grid:2", "grid:64", "sobol:1", "sobol:4096", "adaptive:0.01", "edges:0.0001"}) {
        ASSERT_TRUE(parse_aa_mode(text).has_value()) << text;
        EXPECT_EQ(to_string(*parse_aa_mode(text)), text);
    }
    EXPECT_EQ(parse_aa_mode("grid:1"), grid_aa(1));
    for (const char* bad : {"", "grid", "grid:", "grid:0", "grid:65", "grid:2x", "Grid:2",
                            "sobol:0", "sobol:4097", "sobol", "adaptive:0", "adaptive:nan",
                            "adaptive:2", "adaptive:", "edges", "edges:0.000009", "edges:1.1"}) {
        EXPECT_FALSE(parse_aa_mode(bad).has_value()) << bad;
    }
}

TEST(Film, HashSeesEveryBitAndTheShape) {
    Film<float> film(4, 3), flat(12, 1);
    const std::uint64_t black = hash_of(film);
    EXPECT_NE(hash_of(flat), black);
    film.rgb[35] = -0.0f;
    EXPECT_NE(hash_of(film), black);
}

TEST(CountNonFinite, CountsPixelsAndNamesTheFirst) {
    Picture made{4, 3, 3, std::vector<float>(36)};
    made.pixels[15] = std::numeric_limits<float>::infinity();
    made.pixels[17] = std::nanf("");
    made.pixels[22] = -std::numeric_limits<float>::infinity();
    EXPECT_EQ(count_non_finite(made), 2u);
    EXPECT_EQ(first_non_finite(made), std::make_pair(1, 1));
}

}  // namespace
}  // namespace rt::this_file
