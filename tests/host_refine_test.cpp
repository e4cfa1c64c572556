// SPDX-License-Identifier: Apache-2.0
//
// Adaptive sampling: edges that refining reveals next to refined pixels are refined too, once.
#include <gtest/gtest.h>

#include "host/render/picture_loop.h"
#include "host/scene/aa_mode.h"

namespace rt {

namespace {

struct Refined {
    std::vector<std::int32_t> pixels;
    int grid;
    bool operator==(const Refined&) const = default;
};

/// A row of pixels: white, then black; a refined pixel is half as bright as the one to its left.
class Halving : public Renderer<float> {
   public:
    std::vector<Refined> calls;

    Rect tile_size(int width) const override { return {0, 0, width, 1}; }
    RendererTimes times() const override { return {}; }

    void render(TileQueue& queue, const Rect&, Film<float>& film) override {
        while (const auto tile = queue.next()) queue.finish(*tile);
        film.rgb[0] = film.rgb[1] = film.rgb[2] = 1;
    }

    void refine(std::span<const std::int32_t> pixels, int grid, TileQueue&, const Rect&,
                Film<float>& film) override {
        calls.push_back({{pixels.begin(), pixels.end()}, grid});
        for (const std::int32_t pixel : pixels) {
            if (pixel == 0) continue;
            const auto first = static_cast<std::size_t>(pixel) * 3;
            for (std::size_t c = first; c < first + 3; ++c) film.rgb[c] = film.rgb[c - 3] / 2;
        }
    }
};

std::vector<Refined> refined(const char* aa) {
    const Rect region{0, 0, 6, 1};
    const StopFlag never_stop = 0;
    TileQueue queue(make_tiles(region, 6, 1), never_stop);
    Film<float> film(6, 1);
    Halving renderer;
    const RenderedAll result = render_all(renderer, *parse_aa_mode(aa), queue, region, film);
    EXPECT_TRUE(result.is_finished);
    EXPECT_EQ(result.plan_seconds > 0, !renderer.calls.empty());
    return renderer.calls;
}

TEST(RenderAll, RefinesTwiceWhereRefiningRevealsAnEdge) {
    // First white against black, 1 / 8 <= .2; then pixel 2, beside pixel 1, which became 1/2. That
    // pixel 2 becomes 1/4 triggers nothing more.
    EXPECT_EQ(refined("adaptive:0.2"), (std::vector<Refined>{{{0, 1}, 8}, {{2}, 4}}));
    EXPECT_EQ(refined("adaptive:0.5"), (std::vector<Refined>{{{0, 1}, 2}}));
}

TEST(RenderAll, RefinesNothingWithARegularGrid) { EXPECT_TRUE(refined("grid:2").empty()); }

}  // namespace

}  // namespace rt
