// SPDX-License-Identifier: Apache-2.0
//
// Every set of features that a scene can need gives the same bits as all features: the kernels with
// their switches as variables, in packets and one ray at a time.
#include <gtest/gtest.h>

#include <bit>

#include "host/flatten/flat_scene.h"
#include "host/render/threads_renderer.h"
#include "host/render/tile_rounds.h"
#include "tests/feature_scenes.h"
#include "tests/render_helpers.h"

extern "C" {
/// What tests/switchable_features.h reads.
int rt_switches;

#define DECLARE_SWITCHABLE(name)                                                    \
    void name##_pixels(float*, rt::f32::RayCounts*, const rt::NativeView<float>*,   \
                       const rt::f32::Tile*, rt::f32::Index, rt::f32::Index);       \
    void name##_centers(float*, rt::f32::RayCounts*, const rt::NativeView<float>*,  \
                        const rt::f32::Tile*, rt::f32::Index, rt::f32::Index);      \
    void name##_round(float*, rt::f32::RayCounts*, const rt::NativeView<float>*,    \
                      const rt::f32::Tile*, float*, rt::f32::Index, rt::f32::Index, \
                      rt::f32::Index)
DECLARE_SWITCHABLE(rt_switchable_1);
DECLARE_SWITCHABLE(rt_switchable_8);
}

namespace rt::test::this_file {
namespace {

/// With the entry points that are called here.
#define SWITCHABLE(lanes)                                                      \
    {                                                                          \
        "", lanes, {}, lanes, 0, rt_switchable_##lanes##_pixels, {}, {}, {},   \
            rt_switchable_##lanes##_centers, rt_switchable_##lanes##_round, {} \
    }
const NativeKernels<float> single SWITCHABLE(1), packets SWITCHABLE(8);

std::uint64_t hash_by(const NativeKernels<float>& kernels, const FlatScene<float>& flat) {
    const Rect whole{0, 0, flat.params.width, flat.params.height};
    const auto tile = flat_tile<float>(whole, whole);
    const PacketShape shape = packet_shape(kernels.lanes, flat.params.samples);
    const int across = (whole.width + shape.width - 1) / shape.width;
    const int down = (whole.height + shape.height - 1) / shape.height;
    Film<float> film(whole.width, whole.height);
    f32::RayCounts counts{};
    const NativeView<float> view = native_view(flat);
    if (flat.params.tolerance > 0) {
        std::vector<float> planes;
        render_tile_in_rounds(kernels, view, tile, planes, film.rgb.data(), counts,
                              [] { return false; });
    } else {
        kernels.render_pixels(film.rgb.data(), &counts, &view, &tile, 0, across * down);
    }
    return hash_of(film);
}

TEST(Switches, EveryPossibleSetGivesTheBitsOfAllFeatures) {
    ThreadsOptions everything;
    everything.kernels.features = every_feature;
    int sets = 0;
    for (int bits = 0; bits < 1 << feature_names.size(); ++bits) {
        const Features features = Features(static_cast<unsigned>(bits));
        if (!is_possible(features)) continue;
        ++sets;
        const Scene scene = scene_needing(features);
        const FlatScene<float> flat = flatten<float>(scene);
        ASSERT_EQ(flat.features, features) << bits;
        const std::uint64_t expected = hash_of(render_on_threads<float>(scene, everything));
        rt_switches = bits;
        EXPECT_EQ(hash_by(single, flat), expected) << bits;
        EXPECT_EQ(hash_by(packets, flat), expected) << bits;
    }
    EXPECT_GT(sets, 2000);
}

/// Otherwise the test above would compare a picture with itself.
TEST(Switches, DoSomething) {
    const FlatScene<float> flat = flatten<float>(scene_needing(Features(0xfff)));
    rt_switches = 0xfff;
    const std::uint64_t all = hash_by(packets, flat);
    for (const int bit : {0, 3, 4, 5, 7, 8, 9, 10, 11}) {
        rt_switches = 0xfff & ~(1 << bit);
        EXPECT_NE(hash_by(packets, flat), all) << feature_names[bit];
    }
    const FlatScene<float> with_edges = flatten<float>(scene_needing(Features(0x17ff)));
    rt_switches = 0x17ff;
    const std::uint64_t found = hash_by(packets, with_edges);
    rt_switches = 0x7ff;
    EXPECT_NE(hash_by(packets, with_edges), found);
}

}  // namespace
}  // namespace rt::test::this_file
