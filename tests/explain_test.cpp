// SPDX-License-Identifier: Apache-2.0
//
// Ray trees of pixels, against pictures in double, which they must reproduce to the bit.
#include <gtest/gtest.h>

#include <random>

#include "host/explain/ray_tree.h"
#include "host/scene/scene_file.h"
#include "tests/render_helpers.h"

namespace rt::test::this_file {
namespace {

/// Checks the tree's own sums: local light is ambient light plus the lights' contributions.
void check_parts(const RayNode& ray) {
    if (ray.hit) {
        glm::dvec3 sum = ray.hit->ambient;
        for (const LightAtHit& light : ray.hit->lights) sum += light.color;
        for (int i = 0; i < 3; ++i) ASSERT_EQ(sum[i], ray.color[i]) << ray.hit->object;
    }
    for (const RayNode& child : ray.children) {
        ASSERT_EQ(child.bounce, ray.bounce + 1);
        check_parts(child);
    }
}

class ExplainedScene : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(ExplainedScene, AddsUpToItsPixels) {
    Scene scene = load_scene(GetParam().string());
    set_image_size(scene, 160, 120);
    scene.aa = grid_aa(1);
    const FlatScene<double> flat = flatten<double>(scene);
    const Film<double> film = render_on_threads<double>(scene);
    std::mt19937 random(1);
    for (int i = 0; i < 1000; ++i) {
        const int x = static_cast<int>(random() % 160), y = static_cast<int>(random() % 120);
        const ExplainedPixel pixel = explain_pixel(flat, x, y);
        const auto trees = ray_trees(pixel, scene, flat);
        ASSERT_EQ(trees.size(), 1u);
        const glm::dvec3 sum = color_of(trees[0].ray);
        for (int c = 0; c < 3; ++c) {
            const double rendered = film.rgb[static_cast<std::size_t>(3 * (y * 160 + x) + c)];
            ASSERT_EQ(pixel.color[c], rendered) << x << ',' << y;
            ASSERT_EQ(sum[c], rendered) << x << ',' << y;
        }
        check_parts(trees[0].ray);
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ExplainedScene, testing::ValuesIn(scene_files()), scene_name);
INSTANTIATE_TEST_SUITE_P(Gallery, ExplainedScene, testing::ValuesIn(scene_files("gallery")),
                         scene_name);

TEST(Explain, HasATreeForEachSample) {
    Scene scene = load_named_scene("glass");
    set_image_size(scene, 80, 60);
    scene.aa = grid_aa(2);
    const FlatScene<double> flat = flatten<double>(scene);
    const Film<double> film = render_on_threads<double>(scene);
    for (const auto& [x, y] : {std::pair{40, 30}, {20, 40}, {5, 5}}) {
        const auto trees = ray_trees(explain_pixel(flat, x, y), scene, flat);
        ASSERT_EQ(trees.size(), 4u);
        glm::dvec3 sum(0);
        for (const SampleTree& tree : trees) sum += color_of(tree.ray);
        for (int c = 0; c < 3; ++c) {
            EXPECT_DOUBLE_EQ(sum[c] / 4, film.rgb[static_cast<std::size_t>(3 * (y * 80 + x) + c)]);
        }
    }
}

TEST(Explain, SaysWhereASphereWasHit) {
    Scene scene;
    scene.width = scene.height = 3;
    scene.camera.from = {10, 20, 35};
    scene.camera.at = {10, 20, 0};
    scene.camera.window = {-1, 1, -1, 1};
    scene.aa = grid_aa(1);
    scene.ambient_light = {1, 1, 1};
    scene.materials = {{"matt", {0.1, 0.2, 0.3}, {0.5, 0.5, 0.5}}};
    scene.spheres = {{{100, 0, 0}, 1, 0}, {{10, 20, 30}, 2, 0}};
    scene.lights = {
        {{10, 20, 1000}, {0, 0, 0}}, {{10, 20, 135}, {1, 1, 1}}, {{10, 20, -99}, {1, 1, 1}}};
    const FlatScene<double> flat = flatten<double>(scene);
    const auto trees = ray_trees(explain_pixel(flat, 1, 1), scene, flat);
    const RayNode& ray = trees.at(0).ray;
    ASSERT_TRUE(ray.hit);
    EXPECT_EQ(ray.hit->object, "sphere 2");
    EXPECT_EQ(ray.hit->material, "matt");
    EXPECT_NEAR(ray.hit->distance, 3, 1e-14);
    EXPECT_NEAR(ray.hit->point.x, 10, 1e-13);
    EXPECT_NEAR(ray.hit->point.z, 32, 1e-13);
    EXPECT_NEAR(ray.hit->normal.z, 1, 1e-15);
    ASSERT_EQ(ray.hit->lights.size(), 2u);  // one is dark
    EXPECT_EQ(ray.hit->lights[0].light, 1u);
    EXPECT_EQ(ray.hit->lights[0].state, LightAtHit::State::lit);
    EXPECT_NEAR(ray.hit->lights[0].color.x, 0.5, 1e-15);
    EXPECT_EQ(ray.hit->lights[1].light, 2u);
    EXPECT_EQ(ray.hit->lights[1].state, LightAtHit::State::behind);
    EXPECT_NEAR(ray.color.z, 0.8, 1e-15);
    EXPECT_TRUE(ray.children.empty());
}

}  // namespace
}  // namespace rt::test::this_file
