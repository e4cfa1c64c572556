// SPDX-License-Identifier: Apache-2.0
//
// The estimate of a picture's error, against the error itself.
#include "host/render/estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "host/flatten/flat_scene.h"
#include "host/picture/render_picture.h"
#include "tests/render_helpers.h"

namespace rt::test::this_file {

namespace {

const StopFlag go = 0;

Scene small_scene(const char* stem, const char* aa, int size = 120) {
    Scene scene = load_named_scene(stem);
    set_image_size(scene, size, size);
    scene.aa = *parse_aa_mode(aa);
    return scene;
}

template <typename T>
ErrorEstimate estimate(const Scene& scene, const Film<T>& film, const ThreadsOptions& options = {},
                       Rect region = {}) {
    const FlatScene<T> flat = flatten<T>(scene);
    if (region.width == 0) region = {0, 0, scene.width, scene.height};
    const ErrorEstimator<T> estimator{flat, region, options, go};
    return estimator.trace_controls(scene.aa, film)->estimate_of(film);
}

/// Far more samples than any picture here, and another seed.
const Film<float>& converged(Scene scene) {
    static std::map<std::string, Film<float>> known;
    const std::string key = scene.name + to_string(scene.filter) + std::to_string(scene.width);
    if (const auto found = known.find(key); found != known.end()) return found->second;
    scene.aa = *parse_aa_mode("sobol:1024");
    scene.sampling_seed = 7;
    return known.emplace(key, render_on_threads<float>(scene)).first->second;
}

class EveryMode : public testing::TestWithParam<const char*> {};

TEST_P(EveryMode, EstimateIsNearTheError) {
    for (const char* stem : {"cornell-box", "many-lights"}) {
        const Scene scene = small_scene(stem, GetParam());
        const Film<float> film = render_on_threads<float>(scene);
        const double rmse = film_error(film, converged(scene)).rmse;
        const ErrorEstimate about = estimate(scene, film);
        EXPECT_GT(rmse, 3e-4) << stem;
        EXPECT_LT(about.rmse, 2 * rmse) << stem;
        EXPECT_GT(about.rmse, rmse / 2) << stem;
        EXPECT_LT(about.low, about.rmse) << stem;
        EXPECT_GT(about.high, about.rmse) << stem;
    }
}

INSTANTIATE_TEST_SUITE_P(ErrorEstimate, EveryMode,
                         testing::Values("none", "grid:2", "grid:8", "sobol:4", "sobol:64",
                                         "adaptive:0.1", "adaptive:0.02", "edges:0.01"));

TEST(ErrorEstimate, IsRelativeToTheFilterOfThePicture) {
    for (const Filter filter : {Filter::tent, Filter::gaussian, Filter::mitchell}) {
        Scene scene = small_scene("cornell-box", "sobol:16");
        scene.filter = filter;
        const Film<float> film = render_on_threads<float>(scene);
        const double rmse = film_error(film, converged(scene)).rmse;
        EXPECT_NEAR(std::log2(estimate(scene, film).rmse / rmse), 0, 0.5) << to_string(filter);
    }
}

TEST(ErrorEstimate, FindsAnyMistake) {
    const Scene scene = small_scene("cornell-box", "sobol:256");
    Film<float> film = render_on_threads<float>(scene);
    for (float& value : film.rgb) value *= 0.98F;
    const double rmse = film_error(film, converged(scene)).rmse;
    EXPECT_NEAR(estimate(scene, film).rmse, rmse, 0.05 * rmse);
}

TEST(ErrorEstimate, IsThatOfTheCrop) {
    const Scene scene = small_scene("cornell-box", "grid:2");
    const Rect whole{0, 0, 120, 120}, crop{30, 60, 80, 50};
    const Film<float> film = part_of(render_on_threads<float>(scene), whole, crop);
    const double rmse = film_error(film, part_of(converged(scene), whole, crop)).rmse;
    EXPECT_NEAR(estimate(scene, film, {}, crop).rmse, rmse, 0.3 * rmse);
}

TEST(ErrorEstimate, OfDoubleIsThatOfFloat) {
    const Scene scene = small_scene("cornell-box", "grid:2");
    const double in_float = estimate(scene, render_on_threads<float>(scene)).rmse;
    const double in_double = estimate(scene, render_on_threads<double>(scene)).rmse;
    EXPECT_NE(in_double, in_float);
    EXPECT_NEAR(in_double, in_float, 0.05 * in_float);
}

TEST(ErrorEstimate, CostsTheSameForAnySize) {
    for (const int size : {100, 700}) {
        const Scene scene = small_scene("cornell-box", "none", size);
        const ErrorEstimate about = estimate(scene, render_on_threads<float>(scene));
        EXPECT_LE(about.pixels, 512);
        EXPECT_LE(about.samples, 0.6 * 500 * 500);
        EXPECT_GE(about.samples, 0.3 * 500 * 500);
    }
}

TEST(ErrorEstimate, TakesMoreSamplesForASmallError) {
    const Scene scene = small_scene("single-sphere", "sobol:1024", 60);
    const Film<float> film = render_on_threads<float>(scene);
    const ErrorEstimate about = estimate(scene, film);
    EXPECT_GT(about.samples, 2 * 64 * about.pixels + 8 * 3600);
    EXPECT_LT(about.low, film_error(film, converged(scene)).rmse);
    EXPECT_LT(about.high, 3e-4);
}

TEST(ErrorEstimate, LeavesOutPixelsThatAreNotFinite) {
    const Scene scene = small_scene("cornell-box", "grid:2", 30);
    Film<float> film = render_on_threads<float>(scene);
    const double before = estimate(scene, film).rmse;
    film.rgb[3 * 450] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NEAR(estimate(scene, film).rmse, before, 0.3 * before);
}

TEST(ErrorEstimate, OfAnExactPictureIsZero) {
    Scene scene = small_scene("empty", "grid:2", 20);
    scene.background = glm::dvec3(0.5);
    const ErrorEstimate about = estimate(scene, render_on_threads<float>(scene));
    EXPECT_EQ(about.rmse, 0);
    EXPECT_EQ(about.low, 0);
    EXPECT_EQ(about.high, 0);
}

TEST(ErrorEstimate, SaysWhatIsTooSmallToTell) {
    EXPECT_EQ(to_string(ErrorEstimate{8.1e-4, 6e-4, 1.1e-3}),
              "RMSE about 8.1e-4 (6.0e-4 to 1.1e-3)");
    EXPECT_EQ(to_string(ErrorEstimate{0, 0, 1.1e-3}), "RMSE below 1.1e-3");
    EXPECT_EQ(to_string(ErrorEstimate{0, 0, 0}), "no error found");
}

TEST(ErrorEstimate, EndsAtAStopSignal) {
    const Scene scene = small_scene("cornell-box", "none", 20);
    StopFlag stop = 0;
    RenderEvents events;
    events.ended = [&] { stop = 1; };
    RenderSettings settings;
    settings.estimate = true;
    const RenderStats stats =
        render_picture(
            scene, settings, [] { return std::vector{threads_choice()}; }, events, stop)
            .stats;
    EXPECT_TRUE(stats.complete());
    EXPECT_FALSE(stats.estimate);
}

/// Threads of this process.
int threads_now() {
    const std::filesystem::directory_iterator begin("/proc/self/task"), end;
    return static_cast<int>(std::distance(begin, end));
}

TEST(ErrorEstimate, UsesNoMoreThreadsThanTheRenderer) {
    const Scene scene = small_scene("single-sphere", "sobol:1024", 60);
    const int expected = threads_now() + 1;  // the watcher
    int most = 0;
    std::jthread watcher;
    RenderEvents events;
    events.ended = [&] {
        watcher = std::jthread([&](const std::stop_token& stop) {
            while (threads_now() > expected) continue;  // the renderer's thread ends
            while (!stop.stop_requested()) most = std::max(most, threads_now());
        });
    };
    RenderSettings settings;
    settings.estimate = true;
    render_picture(
        scene, settings, [] { return std::vector{threads_choice(1)}; }, events, go);
    watcher = {};
    EXPECT_LE(most, expected);
}

TEST(ControlPixels, OfOnePixelTellNoiseFromNoError) {
    const std::vector<double> dark(3, 0.0), light(3, 0.5);
    const ControlPixels controls{{3}, {1}, {1}, 1, {dark, light}, 4, 8};
    const ErrorEstimate between = controls.estimate(std::vector<double>(3, 0.4));
    EXPECT_EQ(between.rmse, 0);
    EXPECT_DOUBLE_EQ(between.high, 0.5);
    EXPECT_EQ(controls.estimate(dark).high, 0.5);
    const ErrorEstimate beyond = controls.estimate(std::vector<double>(3, 1.0));
    EXPECT_DOUBLE_EQ(beyond.rmse, std::sqrt(0.5));
    EXPECT_DOUBLE_EQ(beyond.low, 0.5);
    EXPECT_DOUBLE_EQ(beyond.high, std::sqrt(0.75));
}

TEST(ControlPixels, WeighWhatTheyStandFor) {
    const ControlPixels controls{{3, 8},
                                 {0.1, 0.4},
                                 {0.1, 0.1},
                                 2,
                                 {std::vector<double>{0, 0, 0, 0.5, 2, 1}, {0, 0, 0, 0.5, 1, 1}},
                                 4,
                                 20};
    // Off by 1 in every channel; off by .3, -.2 and, clamped, 0.
    const ErrorEstimate about = controls.estimate(std::vector<double>{1, 1, 1, 0.8, 0.8, 3});
    const double first = 0.1, second = 0.4 * (0.09 + 0.04) / 3;
    EXPECT_NEAR(about.rmse, std::sqrt(first + second), 1e-12);
    EXPECT_EQ(about.samples, 20);
    // Of drawing these two from the candidates, and two candidates from the picture.
    const double square = std::pow(first + second, 2) / 2;
    const double drawn = first * first + second * second - square;
    const double candidates = first * first + second * second / 4 - square;
    const double margin = 1.645 * std::sqrt(drawn + candidates);
    EXPECT_NEAR(about.high, std::sqrt(first + second + margin), 1e-12);
    EXPECT_EQ(about.low, 0);
}

}  // namespace

}  // namespace rt::test::this_file
