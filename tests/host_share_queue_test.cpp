// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>

#include "host/journal/share_queue.h"

namespace {

using Turn = rt::ShareQueue::Turn;

TEST(ShareQueue, HandsEveryShareOutOnce) {
    rt::ShareQueue queue(3);
    std::set<int> shares;
    for (int i = 0; i < 3; ++i) {
        const auto turn = queue.take(0);
        ASSERT_TRUE(turn);
        EXPECT_EQ(turn->attempt, 0);
        shares.insert(turn->share);
    }
    EXPECT_EQ(shares, (std::set{0, 1, 2}));
    EXPECT_FALSE(queue.take(0.1));
    for (const int share : shares) {
        EXPECT_FALSE(queue.is_done());
        queue.finish({share, 0}, 0.2);
    }
    EXPECT_TRUE(queue.is_done());
    EXPECT_FALSE(queue.take(100));
}

TEST(ShareQueue, HandsTheLatestOutAgain) {
    rt::ShareQueue queue(2);
    const Turn slow = *queue.take(0), quick = *queue.take(1);
    queue.finish(quick, 11);  // took 10 s
    EXPECT_FALSE(queue.take(19));
    const auto again = queue.take(21);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->share, slow.share);
    EXPECT_EQ(again->attempt, 1);
    EXPECT_FALSE(queue.take(22));  // it is given as much time as the first had
    EXPECT_TRUE(queue.take(42));
}

TEST(ShareQueue, TakesWhoeverFinishesFirst) {
    rt::ShareQueue queue(1);
    const Turn first = *queue.take(0);
    const Turn second = *queue.take(50);
    queue.finish(first, 51);
    queue.finish(second, 52);
    EXPECT_TRUE(queue.is_done());
    ASSERT_EQ(queue.finished().size(), 1U);
    EXPECT_EQ(queue.finished()[0].attempt, 0);
}

TEST(ShareQueue, WhatIsGivenBackGoesOutAtOnce) {
    rt::ShareQueue queue(2);
    const Turn failed = *queue.take(0);
    EXPECT_TRUE(queue.take(0));
    queue.give_back(failed);
    const auto again = queue.take(0.1);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->share, failed.share);
    queue.give_back(failed);  // another has taken it since
    EXPECT_FALSE(queue.take(0.2));
}

}  // namespace
