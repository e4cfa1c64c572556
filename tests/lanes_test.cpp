// SPDX-License-Identifier: Apache-2.0
//
// Packets of any number of lanes give the bits of lone rays.
#include <gtest/gtest.h>

#include <cstdint>

#include "host/scene/aa_mode.h"
#include "tests/render_helpers.h"

namespace rt::test {
namespace {

class EveryLaneWidth : public testing::TestWithParam<int> {
   protected:
    template <typename T>
    void expect_the_twins_hash(const char* stem, const char* aa, const ClOptions& chosen) const {
        Scene scene = load_scene(stem);
        set_image_size(scene, 83, 61);
        scene.aa = parse_aa_mode(aa).value();
        ClOptions options = chosen;
        options.lanes = GetParam();
        EXPECT_EQ(hash_of(render_on_device<T>(scene, options)),
                  hash_of(render_on_threads<T>(scene)))
            << stem << " " << aa;
    }
};

/// One, two and four samples of a pixel in a packet. All features: one program for every scene.
TEST_P(EveryLaneWidth, GivesTheTwinsBits) {
    for (const char* stem :
         {"cornell-box", "vertex-normals", "many-lights", "cones", "glass", "mirror-hall"}) {
        for (const char* aa : {"grid:1", "grid:2", "grid:3", "sobol:6"}) {
            for (const Launch launch : {Launch::pixel, Launch::sample}) {
                const ClOptions options = cl_options(launch, true);
                expect_the_twins_hash<float>(stem, aa, options);
                if (test_device().has_double) expect_the_twins_hash<double>(stem, aa, options);
            }
        }
    }
}

/// The number of samples is compiled in where a packet of pixels holds them.
TEST_P(EveryLaneWidth, GivesTheTwinsBitsWithWhatTheSceneNeedsAlone) {
    const ClOptions pixel = cl_options(Launch::pixel), sample = cl_options(Launch::sample);
    for (const char* aa : {"grid:1", "grid:2", "grid:3"}) {
        expect_the_twins_hash<float>("cornell-box", aa, pixel);
    }
    for (const char* stem : {"vertex-normals", "many-lights", "cones", "glass"}) {
        expect_the_twins_hash<float>(stem, "grid:2", pixel);
    }
    expect_the_twins_hash<float>("glass", "sobol:6", sample);
    expect_the_twins_hash<float>("cornell-box", "grid:2", sample);
    if (test_device().has_double) expect_the_twins_hash<double>("cones", "grid:3", pixel);
}

INSTANTIATE_TEST_SUITE_P(Lanes, EveryLaneWidth, testing::Values(1, 2, 4, 8, 16));

}  // namespace
}  // namespace rt::test
