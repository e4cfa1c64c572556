// SPDX-License-Identifier: Apache-2.0
//
// host/flatten/casters: the lists of triangles that may cast a light's shadow leave out those that
// cannot, and change no picture.
#include <gtest/gtest.h>

#include <filesystem>

#include "host/render/threads_renderer.h"
#include "host/scene/scene_file.h"
#include "tests/hit_scenes.h"
#include "tests/whole_film.h"

namespace rt::this_file {
namespace {

template <typename T>
std::uint64_t picture_hash(const Scene& scene, const FlattenOptions& options) {
    const FlatScene<T> flat = flatten<T>(scene, options);
    return hash_of(whole_film(*make_threads_renderer(flat, {}), scene.width, scene.height));
}

std::vector<std::filesystem::path> scene_files() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(MIRRORBALL_SCENES_DIR)) {
        const std::string name = entry.path().filename().string();
        if (name.ends_with(".json") && !name.ends_with(".schema.json") && name != "golden.json")
            files.push_back(entry);
    }
    return files;
}

template <typename T>
class CasterLists : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(CasterLists, Precisions);

// Sanitizer runs look for other bugs than wrong pixels, and trace rays 13 times as slowly.
#ifdef MIRRORBALL_SANITIZED
constexpr int divisor = 3;
#else
constexpr int divisor = 1;
#endif

TYPED_TEST(CasterLists, GiveThePicturesOfEveryTriangleCasting) {
    for (const auto& file : scene_files()) {
        SCOPED_TRACE(file.filename());
        Scene scene = load_scene(file.string());
        set_image_size(scene, scene.width / divisor, scene.height / divisor);
        FlattenOptions everything;
        everything.caster_lists = false;
        EXPECT_EQ(picture_hash<TypeParam>(scene, {}), picture_hash<TypeParam>(scene, everything));
    }
}

/// The triangles that may cast a shadow, by light.
std::vector<std::vector<int>> casters(const Scene& scene) {
    const FlatScene<float> flat = flatten<float>(scene);
    std::vector<std::vector<int>> lists;
    for (const auto& light : flat.lights) {
        lists.emplace_back();
        for (int k = 0; k < light.caster_count; ++k) {
            const bool all = light.caster_count == flat.params.triangle_count;
            lists.back().push_back(all ? k : flat.casters[std::size_t(light.first_caster + k)]);
        }
    }
    return lists;
}

TEST(ShadowCasters, AreThePyramidAloneInThePapersScene) {
    const auto lists =
        casters(load_scene(std::string(MIRRORBALL_SCENES_DIR) + "/cornell-box.json"));
    ASSERT_EQ(lists.size(), 2u);
    for (const auto& list : lists) EXPECT_EQ(list.size(), 3u);
}

/// A floor at z = 0 seen and lit from above, plus the triangles `more`.
Scene floor_scene(const std::vector<Scene::Triangle>& more) {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].diffuse = {1, 1, 1};
    scene.camera.from = {0, -3, 2};
    scene.lights.push_back({{1, 1, 3}, {1, 1, 1}});
    add_floor(scene, 1, 1);
    scene.triangles.insert(scene.triangles.end(), more.begin(), more.end());
    return scene;
}

// Listing takes time quadratic in the number of triangles.
TEST(ShadowCasters, AreNotListedAmongManyTrianglesWithoutAHierarchyEither) {
    Scene scene = floor_scene({});
    FlattenOptions options;
    options.hierarchies = false;
    EXPECT_NE(flatten<float>(scene, options).lights[0].caster_count, 2);
    for (int i = 0; i < 100; ++i) add_floor(scene, 1, 1);
    const FlatScene<float> flat = flatten<float>(scene, options);
    EXPECT_EQ(flat.lights[0].caster_count, flat.params.triangle_count);
    EXPECT_TRUE(flat.casters.empty());
}

TEST(ShadowCasters, AreNotListedWhereManyPrimitivesAreInTheLightOfMany) {
    Scene scene = floor_scene({});
    scene.spheres.assign(10000, {{0, 0, 1}, 0.5, 0});
    EXPECT_EQ(flatten<float>(scene).lights[0].caster_count, 0);
    scene.lights.assign(1000, scene.lights[0]);
    EXPECT_EQ(flatten<float>(scene).lights[0].caster_count, 2);
}

TEST(ShadowCasters, LeaveOutAFloorUnlessInDoubt) {
    using Lists = std::vector<std::vector<int>>;
    EXPECT_EQ(casters(floor_scene({})), Lists{{}});
    const Scene::Triangle above{{{{0, 0, 1}, {0.5, 0, 1}, {0, 0.5, 1}}}, {}, 0};
    EXPECT_EQ(casters(floor_scene({above})), Lists{{2}});
    const Scene::Triangle below{{{{0, 0, -1}, {0.5, 0, -1}, {0, 0.5, -1}}}, {}, 0};
    EXPECT_EQ(casters(floor_scene({below})), (Lists{{0, 1}}));
    const Scene::Triangle leaning{{{{-1, 1, 0}, {1, 1, 0}, {0, 0, 1}}}, {}, 0};  // over the floor
    EXPECT_EQ(casters(floor_scene({leaning})), (Lists{{2}}));
    Scene scene = floor_scene({leaning});
    scene.lights[0].position = {0, 0, 0.25};  // beneath it: a shadow ray's offset may cross it
    EXPECT_EQ(casters(scene), (Lists{{0, 1, 2}}));
    scene = floor_scene({});
    scene.lights[0].position = {0, 0, 0.001};
    EXPECT_EQ(casters(scene), (Lists{{0, 1}}));
    scene = floor_scene({});
    scene.camera.from.z = -2;
    EXPECT_EQ(casters(scene), (Lists{{0, 1}}));
    scene = floor_scene({});
    scene.spheres.push_back({{0, 0, 0.5}, 0.5, 0});
    EXPECT_EQ(casters(scene), Lists{{}});
    scene.spheres[0].radius = 0.6;
    EXPECT_EQ(casters(scene), (Lists{{0, 1}}));
    scene.spheres[0] = {{0, 0, 1e-5}, 1e-5, 0};  // smaller than a shadow ray's offset
    EXPECT_EQ(casters(scene), (Lists{{0, 1}}));
    scene = floor_scene({});
    scene.cones.push_back({{0, 0, 1e-7}, {0, 0, 1}, 0.5, 1.5, 0});
    EXPECT_EQ(casters(scene), (Lists{{0, 1}}));
    scene.cones[0].base.z = 0.1;
    EXPECT_EQ(casters(scene), Lists{{}});
}

}  // namespace
}  // namespace rt::this_file
