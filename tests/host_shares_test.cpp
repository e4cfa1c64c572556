// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "host/journal/shares.h"

namespace rt::this_file {
namespace {

TEST(ParseShares, ReadsNumbersAndRanges) {
    EXPECT_EQ(parse_shares("7/64"), (Shares{{7}, 64}));
    EXPECT_EQ(parse_shares("20-22,7,9,21/64"), (Shares{{7, 9, 20, 21, 22}, 64}));
    EXPECT_EQ(to_string(Shares{{0}, 1}), "0/1");
    EXPECT_EQ(to_string(Shares{{7, 9, 10, 20, 21, 22}, 64}), "7,9,10,20-22/64");
    for (const char* text : {"", "/", "7", "7/", "/64", "64/64", "0/0", "-1/4", "3-1/4", "1,/4",
                             "1,,2/4", "a/4", "1/4x", "1 /4", "0/100001", "1-2-3/8", "0/-3"}) {
        EXPECT_FALSE(parse_shares(text)) << text;
    }
}

TEST(BlockShares, AreEquallyManyAndApart) {
    for (const int shares : {1, 2, 3, 7, 64}) {
        const std::vector<int> share_of = block_shares(1000, shares);
        int together = 0;
        for (int share = 0; share < shares; ++share) {
            const auto count = std::count(share_of.begin(), share_of.end(), share);
            EXPECT_LE(std::abs(count - 1000 / shares), 1) << shares;
        }
        for (std::size_t i = 1; i < 1000; ++i) together += share_of[i] == share_of[i - 1];
        EXPECT_LT(together, 1000 * 1.5 / shares + 20) << shares;
    }
}

TEST(ShareBlocks, AreAboutAThousand) {
    for (const int side : {500, 1000, 2000, 4000, 8000}) {
        const std::size_t blocks = share_blocks({0, 0, side, side}).size();
        EXPECT_GT(blocks, 250u) << side;
        EXPECT_LE(blocks, 1024u) << side;
    }
    EXPECT_EQ(share_blocks({5, 6, 20, 10}).size(), 2u);
}

TEST(SharedBlocks, AreThePictureTogether) {
    const Rect region{3, 2, 64, 48};
    std::vector<Rect> blocks = shared_blocks({{1}, 3}, region);
    for (const Rect& block : shared_blocks({{0, 2}, 3}, region)) {
        EXPECT_EQ(std::ranges::count(blocks, block), 0);
        blocks.push_back(block);
    }
    EXPECT_TRUE(std::ranges::is_permutation(blocks, share_blocks(region)));
}

}  // namespace
}  // namespace rt::this_file
