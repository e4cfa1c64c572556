// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "host/base/error.h"
#include "host/picture/crew.h"
#include "host/scene/scene_file.h"
#include "tests/refusals.h"

namespace rt::this_file {
namespace {

/// Threads that may get something wrong.
struct Device : Renderer<float> {
    std::unique_ptr<Renderer<float>> threads;
    float brighter = 0;      ///< of the last pixel
    RayCounts miscounted{};  ///< of each tile

    explicit Device(const FlatScene<float>& scene) : threads(make_threads_renderer(scene, {})) {}
    TileSizes tile_sizes(int film_width) const override { return threads->tile_sizes(film_width); }
    void render(TileQueue& queue, const Rect& region, Film<float>& film) override {
        threads->render(queue, region, film);
        film.rgb.back() += brighter;
        queue.add_rays(miscounted);
    }
    RendererTimes times() const override { return threads->times(); }
};

TEST(SelfTest, NoticesOtherBitsAndOtherCountsOfRays) {
    const FlatScene<float> scene = flatten<float>(load_default_scene());
    Device device(scene);
    ClDevice gpu;
    gpu.name = "GPU";
    const auto said = [&] {
        return refusal_of([&] { self_test(device, gpu, scene, ""); }).message;
    };
    EXPECT_EQ(said(), "");
    device.brighter = 1;
    EXPECT_TRUE(said().starts_with("GPU fails its self-test: 1 of ")) << said();
    device.brighter = 0;
    for (const RayCounts& rays : {RayCounts{.shadow = 1}, RayCounts{.mirror = 1}}) {
        device.miscounted = rays;
        EXPECT_TRUE(said().starts_with("GPU fails its self-test: it counts ")) << said();
    }
}

}  // namespace
}  // namespace rt::this_file
