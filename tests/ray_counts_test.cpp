// SPDX-License-Identifier: Apache-2.0
//
// The number of rays that every scene of scenes/ takes: only this test sees work that changes no
// pixel, such as mirror rays that are too faint to matter.
#include <gtest/gtest.h>

#include <array>
#include <map>

#include "host/flatten/flat_scene.h"
#include "tests/render_helpers.h"
#include "tests/whole_film.h"

namespace rt::test::this_file {
namespace {

/// Primary, shadow, mirror and transmitted rays.
using Counts = std::array<std::uint64_t, 4>;

/// At 40 x 30 pixels of 2 x 2 samples, in float: those of scenes/ as version 0.1 traced them, those
/// of the gallery as revision 339f6b0 did.
const std::map<std::string, Counts> expected{
    {"cones", {4800, 6652, 2351, 0}},
    {"cornell-box", {4800, 14620, 2873, 0}},
    {"empty", {4800, 0, 0, 0}},
    {"gallery/chain", {4800, 9016, 5183, 0}},
    {"gallery/kaleidoscope", {4800, 49361, 44754, 0}},
    {"gallery/marbles", {4800, 57548, 35166, 24891}},
    {"gallery/mirror-corridor", {4800, 19881, 7549, 0}},
    {"gallery/newtons-cradle", {4800, 7200, 3988, 0}},
    {"gallery/ring-of-lights", {4800, 111268, 194, 0}},
    {"gallery/vases", {4800, 10258, 6062, 0}},
    {"glass", {4800, 25787, 16365, 10696}},
    {"many-lights", {4800, 85463, 241, 0}},
    {"meshes", {4800, 2243, 105, 0}},
    {"mirror-hall", {4800, 9277, 2703, 0}},
    {"no-lights", {4800, 0, 3090, 0}},
    {"orthographic", {4800, 4049, 319, 0}},
    {"single-sphere", {4800, 1197, 0, 0}},
    {"triangles-only", {4800, 2874, 0, 0}},
    {"two-sided", {4800, 1001, 0, 0}},
    {"vertex-normals", {4800, 6316, 1690, 0}},
};

Scene small_scene(const std::string& stem) {
    Scene scene = load_named_scene(stem);
    set_image_size(scene, 40, 30);
    scene.aa = grid_aa(2);
    return scene;
}

Counts rays_of(Renderer<float>& renderer, const Scene& scene) {
    RayCounts rays;
    whole_film(renderer, scene.width, scene.height, {0, 0, scene.width, 10}, &rays);
    return {rays.primary, rays.shadow, rays.mirror, rays.transmitted};
}

class RaysOfScene : public testing::TestWithParam<std::filesystem::path> {};

/// Its place under scenes/, without the extension.
std::string stem_of(const std::filesystem::path& scene) {
    return scene.lexically_relative(MIRRORBALL_SCENES_DIR).replace_extension().string();
}

TEST_P(RaysOfScene, AreAsManyAsEver) {
    const std::string stem = stem_of(GetParam());
    ASSERT_TRUE(expected.contains(stem)) << "a new scene needs a line in the table above";
    const Scene scene = small_scene(stem);
    const FlatScene<float> flat = flatten<float>(scene);
    EXPECT_EQ(rays_of(*make_threads_renderer(flat, {}), scene), expected.at(stem));
    // With all features: one program for all scenes.
    const auto device = make_cl_renderer(flat, test_device(), cl_options(Launch::pixel, true));
    EXPECT_EQ(rays_of(*device, scene), expected.at(stem));
}

INSTANTIATE_TEST_SUITE_P(Scenes, RaysOfScene, testing::ValuesIn(scene_files()), scene_name);
INSTANTIATE_TEST_SUITE_P(Gallery, RaysOfScene, testing::ValuesIn(scene_files("gallery")),
                         scene_name);

}  // namespace
}  // namespace rt::test::this_file
