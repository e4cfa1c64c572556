// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "host/picture/crew.h"

namespace rt::this_file {
namespace {

TEST(ImpossibleRays, AreNoneUpToARayABounceAndAShadowRayASurfaceAndLight) {
    EXPECT_EQ(impossible_rays({10, 10 * 9 * 2, 50, 30}, 2, 8, false), "");
    EXPECT_NE(impossible_rays({10, 0, 51, 30}, 2, 8, false), "");
    EXPECT_NE(impossible_rays({10, 10 * 9 * 2 + 1, 50, 30}, 2, 8, false), "");
    EXPECT_NE(impossible_rays({10, 1, 0, 0}, 0, 8, false), "");
    EXPECT_NE(impossible_rays({10, 0, 1, 0}, 2, 0, false), "");
}

TEST(ImpossibleRays, AreNoneWithinABinaryTreeOfGlass) {
    EXPECT_EQ(impossible_rays({1, 15, 7, 7}, 1, 3, true), "");
    EXPECT_NE(impossible_rays({1, 15, 8, 7}, 1, 3, true), "");
    EXPECT_NE(impossible_rays({1, 16, 7, 7}, 1, 3, true), "");
    EXPECT_EQ(impossible_rays({1, 0, ~std::uint64_t{0} / 2, 0}, 1, 100000, true), "");
}

}  // namespace
}  // namespace rt::this_file
