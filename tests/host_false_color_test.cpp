// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <set>

#include "host/image/false_color.h"

namespace rt::this_file {
namespace {

using Color = std::array<float, 3>;

Color color_at(const Picture& picture, int x, int y) {
    const std::size_t at = 3 * (static_cast<std::size_t>(y) * picture.width + x);
    return {picture.pixels[at], picture.pixels[at + 1], picture.pixels[at + 2]};
}

constexpr Color black{0, 0, 0}, violet{0.267f, 0.005f, 0.329f}, teal{0.128f, 0.567f, 0.551f},
    yellow{0.993f, 0.906f, 0.144f};

void expect_near(const Color& found, const Color& expected) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], expected[k], 1e-5) << k;
}

TEST(ColorNumbers, GoesFromVioletByTealToYellow) {
    const std::array<float, 4> linear{2, 5, 8, 0}, by_factors{2, 8, 32, 0};
    const std::array pictures{color_numbers(linear, 4, 1, Scale::linear),
                              color_numbers(by_factors, 4, 1, Scale::logarithmic)};
    for (const Picture& picture : pictures) {
        expect_near(color_at(picture, 0, 0), violet);
        expect_near(color_at(picture, 1, 0), teal);
        expect_near(color_at(picture, 2, 0), yellow);
        EXPECT_EQ(color_at(picture, 3, 0), black);
    }
}

TEST(ColorNumbers, HasTheRangeOfWhatIsNotZero) {
    const std::array<float, 4> values{0, 3, 1, 0}, none{};
    EXPECT_EQ(range_of(values).least, 1);
    EXPECT_EQ(range_of(values).most, 3);
    EXPECT_EQ(range_of(none).most, 0);
}

TEST(ColorNumbers, OfOneValueAndOfNone) {
    const std::array<float, 2> one{7, 7}, none{0, 0};
    expect_near(color_at(color_numbers(one, 2, 1, Scale::logarithmic), 1, 0), violet);
    const Picture empty = color_numbers(none, 2, 1, Scale::linear);
    for (const float value : empty.pixels) EXPECT_EQ(value, 0);
}

TEST(ColorNormals, HasXyzAsRedGreenBlue) {
    const std::array<float, 9> normals{0, 0, 1, -1, 0, 0, 0, 0, 0};
    const Picture picture = color_normals(normals, 3, 1);
    expect_near(color_at(picture, 0, 0), {0.5f, 0.5f, 1});
    expect_near(color_at(picture, 1, 0), {0, 0.5f, 0.5f});
    EXPECT_EQ(color_at(picture, 2, 0), black);
}

TEST(ColorIds, HasAColorForEachOfManyNeighbors) {
    std::array<std::int32_t, 100> ids;
    for (int i = 0; i < 100; ++i) ids[static_cast<std::size_t>(i)] = i;
    const Picture picture = color_ids(ids, 100, 1);
    std::set<Color> colors;
    for (int x = 0; x < 100; ++x) colors.insert(color_at(picture, x, 0));
    EXPECT_EQ(colors.size(), 100u);
    EXPECT_EQ(color_at(picture, 0, 0), black);
}

}  // namespace
}  // namespace rt::this_file
