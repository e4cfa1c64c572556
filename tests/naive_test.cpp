// SPDX-License-Identifier: Apache-2.0
//
// kernels/naive: whatever a program does without, it builds with warnings as errors, and renders
// pictures near the robust one where nothing is stiff.
#include <gtest/gtest.h>

#include "host/render/techniques.h"
#include "tests/render_helpers.h"

namespace rt::test {
namespace {

ClOptions without(const Techniques& naive, bool all_features = false) {
    ClOptions options = cl_options(Launch::pixel, all_features);
    options.naive = naive;
    return options;
}

Scene paper_scene() {
    Scene scene = load_scene("cornell-box");
    set_image_size(scene, 250, 250);
    return scene;
}

class EachTechnique : public testing::TestWithParam<Technique> {};

TEST_P(EachTechnique, MakesLittleDifferenceToThePaperScene) {
    Techniques naive;
    naive.*GetParam().flag = true;
    const Scene scene = paper_scene();
    const auto robust = render_on_device<float>(scene, without({}));
    const auto other = render_on_device<float>(scene, without(naive));
    EXPECT_LT(film_error(other, robust).rmse, 0.02);
    const bool is_boxes = GetParam().flag == &Techniques::boxes;  // too few primitives for them
    // Contraction is up to the compiler, and a sphere's normal does not come from the distance.
    const bool may_agree =
        GetParam().flag == &Techniques::arithmetic || GetParam().flag == &Techniques::spheres;
    if (!may_agree) {
        EXPECT_EQ(hash_of(other) != hash_of(robust), !is_boxes);
    }
}

INSTANTIATE_TEST_SUITE_P(Naive, EachTechnique, testing::ValuesIn(techniques),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(AllNaive, IsNearTheRobustPictureAndNotTheSame) {
    const Scene scene = paper_scene();
    const auto robust = render_on_device<float>(scene, without({}));
    const auto naive = render_on_device<float>(scene, without(all_techniques()));
    EXPECT_LT(film_error(naive, robust).rmse, 0.02);
    EXPECT_NE(hash_of(naive), hash_of(robust));
}

TEST(AllNaive, RendersWhatOtherScenesNeed) {
    for (const char* stem : {"cones", "glass", "meshes", "vertex-normals"}) {
        Scene scene = load_scene(stem);
        set_image_size(scene, 40, 30);
        const auto robust = render_on_device<float>(scene, without({}));
        const auto naive = render_on_device<float>(scene, without(all_techniques()));
        EXPECT_LT(film_error(naive, robust).rmse, 0.1) << stem;
    }
}

// In double, rays meet the shared edges on the diagonals exactly, and slip through.
TEST(AllNaive, RendersWithAllFeaturesInDouble) {
    const Scene scene = paper_scene();
    const auto robust = render_on_threads<double>(scene);
    const auto naive = render_on_device<double>(scene, without(all_techniques(), true));
    EXPECT_LT(film_error(naive, robust).rmse, 0.05);
}

}  // namespace
}  // namespace rt::test
