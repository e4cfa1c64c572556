// SPDX-License-Identifier: Apache-2.0
// The metrics of `compare` against numbers worked out by hand.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>

#include "host/image/false_color.h"
#include "host/image/image_error.h"

namespace rt::this_file {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// A row of pixels.
Picture row(int channels, std::vector<float> values) {
    const int width = static_cast<int>(values.size()) / channels;
    return {width, 1, channels, std::move(values)};
}

TEST(ImageError, RelativeMseDividesByTheReference) {
    // (0.5 / 0.51)^2 and (0.25 / 0.26)^2, over four values; swapped, (0.5 / 1.01)^2 and so on.
    const Picture a = row(1, {1, 0.5f, 0.75f, 0}), b = row(1, {0.5f, 0.25f, 0.75f, 0});
    EXPECT_NEAR(image_error(a, b).rel_mse, (0.961168781 + 0.924556213) / 4, 1e-9);
    EXPECT_NEAR(image_error(b, a).rel_mse, (0.245074012 + 0.240292195) / 4, 1e-9);
}

TEST(ImageError, RelativeMseOfBlackIsKeptFinite) {
    EXPECT_NEAR(image_error(row(1, {0.01f}), row(1, {0})).rel_mse, 1, 1e-6);
}

TEST(ImageError, RelativeMseOfANegativeReferenceIsThatOfItsSize) {
    EXPECT_NEAR(image_error(row(1, {0.01f}), row(1, {-0.01f})).rel_mse, 1, 1e-6);
    EXPECT_NEAR(image_error(row(1, {-0.5f}), row(1, {-1})).rel_mse,
                image_error(row(1, {0.5f}), row(1, {1})).rel_mse, 1e-12);
}

TEST(ImageError, CountsPixelsOverLevels) {
    const auto level = [](double levels) { return static_cast<float>(levels / 255); };
    const Picture a = row(3, {level(0.9), 0, 0, 0, level(1.1), 0, 0, 0, level(2.1),  //
                              level(7.9), 0, 0, level(8.1), level(9), 0});
    const ImageError error = image_error(a, row(3, std::vector<float>(15)));
    EXPECT_EQ(error.over_1, 4u);
    EXPECT_EQ(error.over_2, 3u);
    EXPECT_EQ(error.over_8, 1u);
}

TEST(ImageError, NeighboringLevelsOfAnEightBitPictureAreNotOverOne) {
    for (int apart : {1, 2, 8}) {
        for (int level = 0; level + apart < 256; ++level) {
            const ImageError error =
                image_error(row(1, {static_cast<float>(level) / 255.0f}),
                            row(1, {static_cast<float>(level + apart) / 255.0f}));
            EXPECT_EQ(error.over_1, apart > 1 ? 1u : 0u) << level;
            EXPECT_EQ(error.over_2, apart > 2 ? 1u : 0u) << level;
            EXPECT_EQ(error.over_8, 0u) << level;
        }
    }
}

TEST(ImageError, InfinitiesThatAgreeAreNotFiniteAllTheSame) {
    const ImageError error = image_error(row(1, {infinity, 0.5f}), row(1, {infinity, 0.25f}));
    EXPECT_EQ(error.non_finite, 1u);
    EXPECT_EQ(error.rmse, 0.25);
    EXPECT_EQ(error.max_x, 1);
}

TEST(Clamped, KeepsInfinitiesToBeCounted) {
    const Picture shown = clamped(row(1, {-1, 0.5f, 2, infinity}));
    EXPECT_EQ(shown.pixels, (std::vector<float>{0, 0.5f, 1, infinity}));
}

double lightness(const std::array<float, 3>& color) {
    return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
}

TEST(HeatColor, RisesInLightness) {
    for (int i = 0; i < 255; ++i) {
        EXPECT_LT(lightness(heat_color(i / 255.0)), lightness(heat_color((i + 1) / 255.0))) << i;
    }
}

}  // namespace
}  // namespace rt::this_file
