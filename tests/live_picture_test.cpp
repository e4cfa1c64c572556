// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <latch>

#include "host/view/viewer.h"

namespace rt::this_file {
namespace {

using namespace std::chrono_literals;

/// What a viewer was told, and what it waits for.
struct Story {
    std::latch hangs{1}, may_go_on{1}, begins_again{1};
    std::vector<int> finished;  ///< widths of pictures
};

/// Hangs in its first update until it may go on.
struct SlowViewer : Viewer {
    explicit SlowViewer(Story& story) : story_(story) {}

    void begin(int, int) override {
        if (story_.hangs.try_wait()) story_.begins_again.count_down();
    }
    void update(const Picture&, std::span<const Rect>) override {
        if (!story_.hangs.try_wait()) story_.hangs.count_down();
        story_.may_go_on.wait();
    }
    void finish(const Picture& picture) override { story_.finished.push_back(picture.width); }

    Story& story_;
};

Picture black(int size) {
    return {size, size, 3, std::vector<float>(3 * static_cast<std::size_t>(size * size))};
}

TEST(LivePicture, ForgetsAPictureThatViewersDidNotWaitForWhenTheNextBegins) {
    Story story;
    std::vector<std::unique_ptr<Viewer>> viewers;
    viewers.push_back(std::make_unique<SlowViewer>(story));
    LivePicture live(std::move(viewers), 300ms);
    live.begin(4, 4);
    live.put({0, 0, 4, 4}, black(4).pixels);
    story.hangs.wait();
    live.finish(black(4));
    live.begin(50, 50);
    story.may_go_on.count_down();
    story.begins_again.wait();
    while (!live.is_over()) live.finish(black(50));
    EXPECT_EQ(story.finished.front(), 50);
}

}  // namespace
}  // namespace rt::this_file
