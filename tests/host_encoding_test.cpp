// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "host/image/encoding.h"

namespace rt::this_file {
namespace {

int encoded(float value, Encoding encoding) { return encode_8bit({1, 1, 1, {value}}, encoding)[0]; }

TEST(Encode8bit, FollowsTheStandardCurve) {
    // IEC 61966-2-1 evaluated with 50 digits (Python's decimal), then rounded.
    const std::pair<float, int> table[] = {
        {0.0f, 0},    {0.0001f, 0}, {0.001f, 3},  {0.0031308f, 10}, {0.0032f, 11}, {0.01f, 25},
        {0.05f, 63},  {0.1f, 89},   {0.18f, 118}, {0.2140f, 127},   {0.25f, 137},  {0.5f, 188},
        {0.75f, 225}, {0.9f, 243},  {0.99f, 254}, {0.999f, 255},    {1.0f, 255}};
    for (const auto& [value, expected] : table) {
        EXPECT_EQ(encoded(value, Encoding::srgb), expected) << value;
    }
    EXPECT_DOUBLE_EQ(srgb_from_linear(1.0), 1.0);
}

TEST(Encode8bit, ClampsAndSendsNanToZero) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const Encoding encoding : {Encoding::display, Encoding::srgb, Encoding::linear}) {
        EXPECT_EQ(encoded(-1.0f, encoding), 0);
        EXPECT_EQ(encoded(-infinity, encoding), 0);
        EXPECT_EQ(encoded(std::nanf(""), encoding), 0);
        EXPECT_EQ(encoded(1.5f, encoding), 255);
        EXPECT_EQ(encoded(infinity, encoding), 255);
    }
}

}  // namespace
}  // namespace rt::this_file
