// SPDX-License-Identifier: Apache-2.0
//
// Packets of any number of lanes give the same bits as single rays, on devices as on threads.
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "host/scene/aa_mode.h"
#include "tests/render_helpers.h"

namespace rt::test::this_file {
namespace {

/// Rendered once for all widths.
template <typename T>
std::uint64_t hash_of_lone_rays(const Scene& scene, const std::string& name) {
    static std::map<std::string, std::uint64_t> known;
    const auto [found, is_new] = known.try_emplace(name);
    if (is_new) {
        ThreadsOptions lone_rays;
        lone_rays.kernels.lanes = 1;
        found->second = hash_of(render_on_threads<T>(scene, lone_rays));
    }
    return found->second;
}

template <typename T>
void expect_the_hash_of_lone_rays(int lanes, const char* stem, const char* aa, bool all_features,
                                  std::vector<Launch> launches = {Launch::pixel, Launch::sample}) {
    Scene scene = load_named_scene(stem);
    set_image_size(scene, 83, 61);
    scene.aa = parse_aa_mode(aa).value();
    const std::uint64_t hash = hash_of_lone_rays<T>(scene, std::string(stem) + " " + aa);
    ThreadsOptions packets;
    packets.kernels.lanes = lanes;
    if (all_features) packets.kernels.features = every_feature;
    EXPECT_EQ(hash_of(render_on_threads<T>(scene, packets)), hash) << stem << " " << aa;
    for (const Launch launch : launches) {
        ClOptions options = cl_options(launch, all_features);
        options.kernels.lanes = lanes;
        EXPECT_EQ(hash_of(render_on_device<T>(scene, options)), hash) << stem << " " << aa;
    }
}

class EveryLaneWidth : public testing::TestWithParam<int> {};

/// One, two and four samples of a pixel in a packet. All features: one program for every scene and
/// compiled-in number of samples. Samples as work items at the widths that GPUs and CPUs use;
/// double at 1 and 8 lanes, the widest vector of doubles.
TEST_P(EveryLaneWidth, GivesTheBitsOfLoneRays) {
    const int lanes = GetParam();
    std::vector<Launch> launches{Launch::pixel};
    if (lanes == 1 || lanes == 16) launches.push_back(Launch::sample);
    for (const char* stem :
         {"cornell-box", "vertex-normals", "many-lights", "cones", "glass", "mirror-hall"}) {
        for (const char* aa : {"grid:1", "grid:2", "grid:3", "sobol:6"}) {
            expect_the_hash_of_lone_rays<float>(lanes, stem, aa, true, launches);
        }
        if (!test_device().has_double || (lanes != 1 && lanes != 8)) continue;
        for (const char* aa : {"grid:2", "sobol:6"}) {
            expect_the_hash_of_lone_rays<double>(lanes, stem, aa, true, {Launch::pixel});
        }
    }
}

/// The number of samples is compiled in. How work is launched does not depend on the scene, so both
/// ways with two programs are enough. One lane, as on GPUs: picture_test has this processor's
/// width.
TEST(OneLane, GivesTheBitsOfLoneRaysWithWhatTheSceneNeedsAlone) {
    for (const char* aa : {"grid:1", "grid:2", "grid:3"}) {
        expect_the_hash_of_lone_rays<float>(1, "cornell-box", aa, false);
    }
    for (const char* stem : {"vertex-normals", "many-lights", "cones"}) {
        expect_the_hash_of_lone_rays<float>(1, stem, "grid:2", false, {Launch::pixel});
    }
    expect_the_hash_of_lone_rays<float>(1, "glass", "sobol:6", false, {Launch::pixel});
    if (test_device().has_double) expect_the_hash_of_lone_rays<double>(1, "cones", "grid:3", false);
}

INSTANTIATE_TEST_SUITE_P(Lanes, EveryLaneWidth, testing::Values(1, 2, 4, 8, 16));

}  // namespace
}  // namespace rt::test::this_file
