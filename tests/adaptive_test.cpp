// SPDX-License-Identifier: Apache-2.0
//
// The adaptive mode is composed of pictures of regular grids: the finer, the more a pixel differs
// from its neighbors; and once more for what that reveals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "host/explain/pixel_facts.h"
#include "tests/render_helpers.h"

namespace rt::test::this_file {
namespace {

/// The largest difference between a pixel and its neighbors, one pair at a time; 1 near a NaN.
template <typename T>
T contrast_of(const Film<T>& film, int x, int y) {
    const auto value = [&](int column, int row, int c) {
        const T v = film.rgb[static_cast<std::size_t>(3 * (row * film.width + column) + c)];
        return std::isnan(v) ? v : std::min(std::max(v, T(0)), T(1));
    };
    T largest = 0;
    for (int i = 0; i < 27; ++i) {
        const int column = x + i % 3 - 1, row = y + i / 3 % 3 - 1, c = i / 9;
        if (column < 0 || column >= film.width || row < 0 || row >= film.height) continue;
        const T d = std::abs(value(column, row, c) - value(x, y, c));
        if (std::isnan(d)) return 1;
        largest = std::max(largest, d);
    }
    return largest;
}

template <typename T>
struct Composed {
    Film<T> film;
    std::vector<std::uint32_t> samples;  ///< of each pixel, the one at its center included
    std::size_t revealed = 0;            ///< pixels that the second round refines
};

template <typename T>
Composed<T> composed(Scene scene, double threshold) {
    scene.aa = grid_aa(1);
    Composed<T> result{render_on_threads<T>(scene), {}};
    std::vector<Film<T>> finer;
    for (const int n : {2, 4, 8, 16}) {
        scene.aa = grid_aa(n);
        finer.push_back(render_on_threads<T>(scene));
    }
    result.samples.assign(result.film.rgb.size() / 3, 1);
    for (int round = 0; round < 2; ++round) {
        const Film<T> before = result.film;
        for (std::size_t i = 0; i < result.samples.size(); ++i) {
            if (result.samples[i] > 1) continue;
            const int pixel = static_cast<int>(i);
            const T contrast = contrast_of(before, pixel % scene.width, pixel / scene.width);
            if (!(contrast > static_cast<T>(threshold))) continue;
            std::size_t level = 0;
            while (level < 3 && contrast > static_cast<T>(threshold) * T(2 << level)) ++level;
            std::copy_n(&finer[level].rgb[3 * i], 3, &result.film.rgb[3 * i]);
            result.samples[i] += 4u << (2 * level);
            result.revealed += static_cast<std::size_t>(round);
        }
    }
    return result;
}

/// How many pixels the second round refines.
template <typename T>
std::size_t expect_composed(Scene scene, double threshold, bool on_device = false) {
    const Composed<T> expected = composed<T>(scene, threshold);
    scene.aa = {AaMode::Pattern::adaptive, 1, threshold};
    EXPECT_EQ(hash_of(render_on_threads<T>(scene)), hash_of(expected.film));
    if (on_device) {
        EXPECT_EQ(hash_of(render_on_device<T>(scene)), hash_of(expected.film));
    }
    const StopFlag never = 0;
    EXPECT_EQ(pixel_work<T>(scene, {0, 0, scene.width, scene.height}, never).samples,
              expected.samples);
    return expected.revealed;
}

TEST(Adaptive, IsComposedOfRegularGrids) {
    std::size_t revealed = 0;
    for (const char* stem : {"cornell-box", "glass", "meshes"}) {
        Scene scene = load_named_scene(stem);
        set_image_size(scene, 71, 53);
        for (const double threshold : {0.3, 0.05, 0.01}) {
            SCOPED_TRACE(std::string(stem) + " " + std::to_string(threshold));
            revealed += expect_composed<float>(scene, threshold);
        }
        expect_composed<double>(scene, 0.05, std::string(stem) == "glass");
    }
    EXPECT_GT(revealed, 100u);
}

TEST(Adaptive, WeighsSamplesByTheFilter) {
    Scene scene = load_named_scene("cornell-box");
    set_image_size(scene, 33, 20);
    scene.filter = Filter::tent;
    expect_composed<float>(scene, 0.05, true);
}

TEST(Adaptive, IsFinestNearANaN) {
    Scene scene = load_named_scene("single-sphere");
    set_image_size(scene, 40, 30);
    scene.materials[0].ambient.y = std::numeric_limits<double>::quiet_NaN();
    expect_composed<float>(scene, 0.2);
}

TEST(Adaptive, SeesNothingBeyondThePicture) {
    Scene scene = load_named_scene("cornell-box");
    for (const auto& [width, height] : {std::pair(1, 1), {1, 40}, {40, 1}, {17, 2}}) {
        set_image_size(scene, width, height);
        expect_composed<float>(scene, 0.02);
    }
}

}  // namespace
}  // namespace rt::test::this_file
