// SPDX-License-Identifier: Apache-2.0
//
// Every combination of features that a scene can produce is built, with warnings as errors, and
// rendered; leaving out changes no bit.
#include <gtest/gtest.h>

#include "host/flatten/flat_scene.h"
#include "tests/render_helpers.h"

namespace rt::test {
namespace {

/// A small scene that needs exactly these features.
Scene scene_needing(const Features& features) {
    Scene scene;
    scene.camera.from = {0, 0.5, 3};
    scene.camera.window = {-1, 1, -0.75, 0.75};
    scene.width = 32;
    scene.height = 24;
    scene.background = {0.1, 0.2, 0.3};
    scene.ambient_light = {0.3, 0.3, 0.3};
    Scene::Material material;
    material.ambient = material.diffuse = {0.8, 0.6, 0.4};
    material.specular = {0.5, 0.5, 0.5};
    material.shininess = 20;
    if (features.mirrors) material.mirror = {0.3, 0.4, 0.5};
    scene.materials.push_back(material);
    if (features.lights) scene.lights = {{{2, 3, 4}, {1, 1, 1}}, {{-3, 1, 2}, {0.4, 0.5, 0.6}}};
    if (features.spheres) scene.spheres = {{{0, 0.2, 0}, 0.7, 0}, {{0.9, 0, 0.6}, 0.4, 0}};
    if (features.triangles) {
        scene.triangles = {{{{{-3, -1, 3}, {3, -1, 3}, {0, -1, -6}}}, {}, 0},
                           {{{{-1, -1, -1}, {-0.2, -1, 0.2}, {-0.8, 1, 0}}}, {}, 0}};
    }
    for (int i = 0; features.hierarchy && i < 24; ++i) {
        const double x = 0.2 * i - 2.4;
        if (features.spheres) {
            scene.spheres.push_back({{x, -0.9, -1}, 0.1, 0});
        } else {
            scene.triangles.push_back({{{{x, -1, -1}, {x + 0.1, -1, -1}, {x, -0.8, -1}}}, {}, 0});
        }
    }
    if (features.vertex_normals) {
        scene.triangles[1].normals = {{{-0.6, 0, 0.8}, {0.6, 0, 0.8}, {0, 0.6, 0.8}}};
    }
    return scene;
}

std::vector<Features> all_combinations() {
    std::vector<Features> combinations;
    for (unsigned bits = 0; bits < 1u << feature_names.size(); ++bits) {
        Features features;
        for (std::size_t i = 0; i < feature_names.size(); ++i) {
            features.*feature_names[i].flag = (bits >> i & 1) != 0;
        }
        const bool any_shape = features.spheres || features.triangles;
        if (features.vertex_normals && !features.triangles) continue;
        if ((features.hierarchy || features.lights || features.mirrors) && !any_shape) continue;
        combinations.push_back(features);
    }
    return combinations;
}

class EveryCombination : public testing::TestWithParam<Features> {};

TEST_P(EveryCombination, IsWhatTheSceneNeedsAndGivesTheBitsOfAllFeatures) {
    const Scene scene = scene_needing(GetParam());
    ASSERT_EQ(flatten<float>(scene).features, GetParam());
    const std::uint64_t reference = hash_of(render_on_threads<float>(scene));
    EXPECT_EQ(hash_of(render_on_device<float>(scene, cl_options(Launch::pixel))), reference);
    EXPECT_EQ(hash_of(render_on_device<float>(scene, cl_options(Launch::pixel, true))), reference);
}

INSTANTIATE_TEST_SUITE_P(Features, EveryCombination, testing::ValuesIn(all_combinations()),
                         [](const auto& info) {
                             std::string name;
                             for (const auto& used : names_of(info.param, true)) name += used + "_";
                             std::replace(name.begin(), name.end(), ' ', '_');
                             return name.empty() ? "nothing" : name.substr(0, name.size() - 1);
                         });

TEST(Flatten, LeavesOutLightsThatShineOnNothing) {
    Scene scene = scene_needing(Features{});
    scene.lights.push_back({{0, 5, 0}, {0, 0, 0}});
    EXPECT_EQ(flatten<float>(scene).lights.size(), 2u);
    scene.materials[0].diffuse = scene.materials[0].specular = {0, 0, 0};
    EXPECT_TRUE(flatten<float>(scene).lights.empty());
    EXPECT_FALSE(flatten<float>(scene).features.lights);
}

TEST(Flatten, MirrorsAreNotNeededWithoutBouncesOrWithoutAnyoneWearingThem) {
    Scene scene = scene_needing(Features{});
    EXPECT_TRUE(flatten<float>(scene).features.mirrors);
    scene.max_bounces = 0;
    EXPECT_FALSE(flatten<float>(scene).features.mirrors);
    scene.max_bounces = 8;
    Scene::Material plain = scene.materials[0];
    plain.mirror = {0, 0, 0};
    scene.materials.push_back(plain);
    for (auto& sphere : scene.spheres) sphere.material = 1;
    for (auto& triangle : scene.triangles) triangle.material = 1;
    EXPECT_FALSE(flatten<float>(scene).features.mirrors);
}

}  // namespace
}  // namespace rt::test
