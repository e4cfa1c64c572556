// SPDX-License-Identifier: Apache-2.0
//
// Packets of any number of lanes give the bits of lone rays.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "host/scene/aa_mode.h"
#include "tests/render_helpers.h"

namespace rt::test {
namespace {

class EveryLaneWidth : public testing::TestWithParam<int> {
   protected:
    template <typename T>
    void expect_the_twins_hash(const char* stem, const char* aa, bool all_features,
                               std::vector<Launch> launches = {Launch::pixel,
                                                               Launch::sample}) const {
        Scene scene = load_scene(stem);
        set_image_size(scene, 83, 61);
        scene.aa = parse_aa_mode(aa).value();
        const std::uint64_t hash = hash_of(render_on_threads<T>(scene));
        for (const Launch launch : launches) {
            ClOptions options = cl_options(launch, all_features);
            options.lanes = GetParam();
            EXPECT_EQ(hash_of(render_on_device<T>(scene, options)), hash) << stem << " " << aa;
        }
    }
};

/// One, two and four samples of a pixel in a packet. All features: one program for every scene.
TEST_P(EveryLaneWidth, GivesTheTwinsBits) {
    for (const char* stem :
         {"cornell-box", "vertex-normals", "many-lights", "cones", "glass", "mirror-hall"}) {
        for (const char* aa : {"grid:1", "grid:2", "grid:3", "sobol:6"}) {
            expect_the_twins_hash<float>(stem, aa, true);
            if (test_device().has_double) expect_the_twins_hash<double>(stem, aa, true);
        }
    }
}

/// The number of samples is compiled in where a packet holds them. How work is launched does not
/// depend on the scene: both ways with two programs are enough.
TEST_P(EveryLaneWidth, GivesTheTwinsBitsWithWhatTheSceneNeedsAlone) {
    for (const char* aa : {"grid:1", "grid:2", "grid:3"}) {
        expect_the_twins_hash<float>("cornell-box", aa, false);
    }
    for (const char* stem : {"vertex-normals", "many-lights", "cones", "glass"}) {
        expect_the_twins_hash<float>(stem, "grid:2", false, {Launch::pixel});
    }
    expect_the_twins_hash<float>("glass", "sobol:6", false, {Launch::pixel});
    if (test_device().has_double) expect_the_twins_hash<double>("cones", "grid:3", false);
}

INSTANTIATE_TEST_SUITE_P(Lanes, EveryLaneWidth, testing::Values(1, 2, 4, 8, 16));

}  // namespace
}  // namespace rt::test
