// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "host/base/error.h"
#include "host/flatten/flat_scene.h"
#include "host/picture/crew.h"
#include "host/scene/scene_file.h"
#include "tests/refusals.h"

namespace rt::this_file {
namespace {

const Rect picture{0, 0, 40, 30};
const StopFlag never = 0;

/// Fills its tiles with one color; fails after a number of them.
struct Painter : Renderer<float> {
    float color = 1;
    int fails_after = -1;  ///< tiles; -1: never
    std::chrono::milliseconds pause{0};
    int done = 0;
    std::int64_t pixels = 0;

    void fail_if_due() {
        if (done++ == fails_after) throw Error(ExitCode::device, "painter fell off");
    }
    TileSizes tile_sizes(int) const override { return {{0, 0, 4, 5}, 1000}; }
    void render(TileQueue& queue, const Rect& region, Film<float>& film) override {
        while (const auto run = queue.next_run([](const Rect& rect) { return rect.width <= 8; })) {
            try {
                fail_if_due();
            } catch (const Error&) {
                queue.give_back(*run);
                throw;
            }
            const Rect& tile = run->whole;
            for (int y = tile.y; y < tile.y + tile.height; ++y) {
                for (int x = tile.x; x < tile.x + tile.width; ++x) {
                    film.rgb[std::size_t(3 * (y * region.width + x))] += color;
                }
            }
            std::this_thread::sleep_for(pause);
            queue.finish(*run);
            pixels += tile.pixels();
        }
    }
    RendererTimes times() const override {
        RendererTimes times;
        times.pixels = pixels;
        return times;
    }
};

TEST(CheckTiles, EndsWhenStopped) {
    Scene scene = load_default_scene();
    set_image_size(scene, 40, 30);
    const Film<float> black(40, 30);
    const auto check = [&](const StopFlag& stop) {
        return check_tiles(flatten<float>(scene), "", make_tiles(picture, 10, 10), 1, picture,
                           black, stop);
    };
    EXPECT_EQ(check(never).wrong_tiles, 12u);
    EXPECT_EQ(check(StopFlag(2)).tiles, 0u);
}

CrewMember<float> member(const std::string& name, float color, int fails_after = -1,
                         std::chrono::milliseconds pause = {}) {
    CrewMember<float> painter{name, {{0, 0, 4, 5}, 1000}, {}, {}};
    painter.make = [=] {
        auto made = std::make_unique<Painter>();
        made->color = color;
        made->fails_after = fails_after;
        made->pause = pause;
        return made;
    };
    return painter;
}

CrewMember<float> failing_to_open(const std::string& name) {
    CrewMember<float> painter = member(name, 1);
    painter.make = []() -> std::unique_ptr<Renderer<float>> {
        throw Error(ExitCode::device, "no ladder");
    };
    return painter;
}

CrewMember<float> waiting_for(const std::shared_ptr<std::atomic<bool>>& gate) {
    CrewMember<float> slow = member("slow", 2);
    slow.make = [gate, make = slow.make] {
        while (!*gate) std::this_thread::yield();
        return make();
    };
    return slow;
}

/// A crew, its messages and its picture.
struct Painting {
    std::vector<std::string> said;
    Film<float> film{picture.width, picture.height};
    TileQueue queue{make_tiles(picture, 4, 5), never};
    Crew<float> crew;

    explicit Painting(std::vector<CrewMember<float>> members)
        : crew(std::move(members), [this](const std::string& line) { said.push_back(line); }) {
        crew.open();
    }
    void render() { crew.render(queue, picture, film); }
    /// The number of pixels of this color.
    std::int64_t count(float color) const {
        std::int64_t found = 0;
        for (std::size_t at = 0; at < film.rgb.size(); at += 3) found += film.rgb[at] == color;
        return found;
    }
    bool is_finished() const { return queue.tiles_finished() == queue.tiles().size(); }
};

TEST(Crew, OfOneRenders) {
    Painting painting({member("a", 1)});
    painting.render();
    EXPECT_EQ(painting.count(1), picture.pixels());
    EXPECT_TRUE(painting.is_finished());
    EXPECT_EQ(painting.crew.times().pixels, picture.pixels());
}

TEST(Crew, OfSeveralSharesTheTiles) {
    const std::chrono::milliseconds pause(1);
    Painting painting({member("a", 1, -1, pause), member("b", 2, -1, pause)});
    painting.render();
    EXPECT_EQ(painting.count(1) + painting.count(2), picture.pixels());
    const std::vector<DeviceShare> shares = painting.crew.shares();
    ASSERT_EQ(shares.size(), 2u);
    EXPECT_EQ(shares[0].pixels, painting.count(1));
    EXPECT_EQ(shares[1].pixels, painting.count(2));
}

TEST(Crew, DoesNotWaitForAMemberThatIsStillBeingMade) {
    auto gate = std::make_shared<std::atomic<bool>>(false);
    const CrewMember<float> slow = waiting_for(gate);
    {
        Painting painting({slow, member("a", 1)});
        painting.render();
        EXPECT_EQ(painting.count(1), picture.pixels());
        EXPECT_EQ(painting.crew.shares()[0].ready, 0);
    }
    *gate = true;  // its thread ends on its own
}

TEST(Crew, GoesOnWithoutAMemberThatFails) {
    const std::chrono::milliseconds pause(1);
    for (const int after : {0, 1, 3}) {
        Painting painting({member("a", 1, after, pause), member("b", 2, -1, pause)});
        painting.render();
        EXPECT_TRUE(painting.is_finished());
        EXPECT_EQ(painting.count(1) + painting.count(2), picture.pixels());
        EXPECT_EQ(painting.said,
                  std::vector<std::string>{"painter fell off; continuing without it"});
        EXPECT_EQ(painting.crew.shares()[0].failure, "painter fell off");
    }
}

TEST(Crew, TellsOfMembersThatAreKnownToFailHoweverQuickTheOthersAre) {
    CrewMember<float> unlisted = member("a", 1);
    unlisted.failure = "painter is not listed";
    Painting painting({unlisted, member("b", 2)});
    painting.render();
    EXPECT_EQ(painting.said,
              std::vector<std::string>{"painter is not listed; continuing without it"});
    EXPECT_EQ(painting.crew.shares()[0].failure, "painter is not listed");
    EXPECT_THROW(Painting({unlisted, unlisted}), Error);
}

TEST(Crew, ThrowsTheLastFailureOnceNobodyIsLeft) {
    EXPECT_THROW(Painting({failing_to_open("a")}), Error);
    Painting one({member("a", 1, 2)});
    EXPECT_EQ(refusal_of([&] { one.render(); }).message, "painter fell off");
    EXPECT_EQ(one.count(1), 8 * 5 * 2);
    EXPECT_EQ(one.crew.shares()[0].pixels, one.count(1));
    EXPECT_EQ(one.said, std::vector<std::string>());
    Painting three({member("a", 1, 1), member("b", 1, 1), failing_to_open("c")});
    EXPECT_THROW(three.render(), Error);
    EXPECT_EQ(three.said.size(), 2u);
    for (const DeviceShare& share : three.crew.shares()) EXPECT_NE(share.failure, "");
}

TEST(Crew, ThrowsWhatATestThrows) {
    CrewMember<float> wrong = member("a", 1);
    wrong.test = [](Renderer<float>&) { throw Error(ExitCode::device, "wrong color"); };
    EXPECT_EQ(refusal_of([&] { Painting painting({wrong}); }).message, "wrong color");
}

TEST(Crew, LeavesErrorsThatAreNotTheDevicesToTheCaller) {
    CrewMember<float> large = member("a", 1);
    large.make = []() -> std::unique_ptr<Renderer<float>> {
        throw Error(ExitCode::limit, "too large a wall");
    };
    EXPECT_EQ(refusal_of([&] { Painting painting({large}); }).exit_code, ExitCode::limit);
}

TEST(Crew, StopsWhileNobodyIsReady) {
    StopFlag stop = 0;
    auto gate = std::make_shared<std::atomic<bool>>(false);
    const CrewMember<float> slow = waiting_for(gate);
    Film<float> film(picture.width, picture.height);
    TileQueue queue(make_tiles(picture, 4, 5), stop);
    {
        Crew<float> crew({slow, slow}, {});
        crew.open();
        std::thread later([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            stop = 2;
        });
        crew.render(queue, picture, film);
        later.join();
    }
    EXPECT_EQ(queue.tiles_finished(), 0u);
    *gate = true;
}

}  // namespace
}  // namespace rt::this_file
