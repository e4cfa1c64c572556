// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "host/scene/scene_file.h"
#include "tests/refusals.h"

namespace rt::this_file {
namespace {

namespace fs = std::filesystem;

const std::string view_text =
    "v\nfrom 1 2 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 64 32\n";

Scene parse(const std::string& entities) {
    return parse_nff_scene(view_text + entities, "some/where/test.nff");
}

TEST(ParseNffScene, BadFilesAreRefusedAsExpected) {
    for (const auto& path : malformed_files(".nff")) {
        expect_announced(path, refusal_of([&] { load_scene(path.string()); }));
    }
}

TEST(ParseNffScene, BlemishesAreNoted) {
    for (const auto& path : blemished_files(".nff")) {
        expect_announced(path, load_scene(path.string()).notes);
    }
}

TEST(ParseNffScene, ViewIsReadAsDocumented) {
    const Scene scene = parse("");
    EXPECT_EQ(scene.name, "test");
    EXPECT_EQ(scene.width, 64);
    EXPECT_EQ(scene.height, 32);
    EXPECT_EQ(scene.max_bounces, 4);
    EXPECT_EQ(scene.camera.from, glm::dvec3(1, 2, 5));
    EXPECT_NEAR(scene.camera.window.top, std::tan(std::numbers::pi / 8), 1e-15);
    EXPECT_NEAR(scene.camera.window.right, 2 * std::tan(std::numbers::pi / 8), 1e-15);
    EXPECT_EQ(scene.background, glm::dvec3(0, 0, 0));
}

TEST(ParseNffScene, HitherAndResolutionMayBeMissing) {
    const Scene scene = parse_nff_scene("v up 0 1 0 at 0 0 0 from 0 0 5 angle 45", "t.nff");
    EXPECT_EQ(scene.width, 512);
    EXPECT_EQ(scene.height, 512);
}

TEST(ParseNffScene, LightsWithoutColorShareTheLight) {
    for (int n = 1; n <= 7; ++n) {
        std::string text;
        for (int i = 0; i < n; ++i) text += "l 1 2 3\n";
        const Scene scene = parse(text);
        const double share = std::sqrt(n) / (2 * n);
        EXPECT_EQ(scene.ambient_light, glm::dvec3(share));
        ASSERT_EQ(scene.lights.size(), static_cast<std::size_t>(n));
        for (const auto& light : scene.lights) EXPECT_EQ(light.intensity, glm::dvec3(share));
    }
}

TEST(ParseNffScene, LightColorsAreTakenAsGivenAndCount) {
    const Scene scene = parse("l 1 2 3 0.1 0.2 0.3\nl 4 5 6\n");
    const double share = std::sqrt(2.0) / 4;
    EXPECT_EQ(scene.lights[0].intensity, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(scene.lights[1].intensity, glm::dvec3(share));
    EXPECT_EQ(scene.ambient_light, glm::dvec3(share));
}

TEST(ParseNffScene, WithoutLightsAmbientIsOne) {
    EXPECT_EQ(parse("").ambient_light, glm::dvec3(1));
}

TEST(ParseNffScene, FillBecomesAMaterial) {
    const Scene scene = parse("f 1 0.5 0.25 0.5 0.3 20 0.8 1.5\ns 0 0 0 1\n");
    ASSERT_EQ(scene.materials.size(), 1u);
    const Scene::Material& material = scene.materials[0];
    EXPECT_EQ(material.diffuse, glm::dvec3(0.5, 0.25, 0.125));
    EXPECT_EQ(material.ambient, material.diffuse);
    EXPECT_EQ(material.specular, glm::dvec3(0.3));
    EXPECT_EQ(material.mirror, glm::dvec3(0.3));
    EXPECT_EQ(material.transmission, glm::dvec3(0.8));
    EXPECT_EQ(material.shininess, 20);
    EXPECT_EQ(material.ior, 1.5);
    EXPECT_TRUE(material.two_sided);
}

TEST(ParseNffScene, EqualFillsShareAMaterial) {
    const Scene scene = parse(
        "f 1 0 0 1 0 0 0 0\ns 0 0 0 1\nf 0 1 0 1 0 0 0 0\ns 0 0 0 1\n"
        "f 1 0 0 1 0 0 0 0\ns 0 0 0 1\n");
    EXPECT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(scene.spheres[2].material, scene.spheres[0].material);
}

TEST(ParseNffScene, BeforeTheFirstFillAllIsWhiteAndMatt) {
    const Scene scene = parse("s 0 0 0 1\n");
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.materials[0].diffuse, glm::dvec3(1));
    EXPECT_EQ(scene.materials[0].specular, glm::dvec3(0));
}

TEST(ParseNffScene, NegativeRadiiAreTakenWithoutSign) {
    const Scene scene = parse("s 1 2 3 -4\nc 0 0 0 -2 0 1 0 -1\n");
    EXPECT_EQ(scene.spheres[0].radius, 4);
    ASSERT_EQ(scene.cones.size(), 1u);
    EXPECT_EQ(scene.cones[0].base_radius, 2);
    EXPECT_EQ(scene.cones[0].apex_radius, 1);
    EXPECT_EQ(scene.cones[0].apex, glm::dvec3(0, 1, 0));
}

TEST(ParseNffScene, CommentsAndLayoutAreFree) {
    const Scene scene = parse("#s 0 0 0 1\ns 0 0\n0 # z\n+.5e0#end\rs 1. 1 1e-999 1 s 0 0 0 1");
    ASSERT_EQ(scene.spheres.size(), 3u);
    EXPECT_EQ(scene.spheres[0].radius, 0.5);
    EXPECT_EQ(scene.spheres[1].center, glm::dvec3(1, 1, 0));
}

TEST(ParseNffScene, PatchesKeepTheirNormals) {
    const Scene scene = parse("pp 3\n0 0 0 0 0 2\n1 0 0 0 3 0\n0 1 0 1 0 0\n");
    ASSERT_EQ(scene.triangles.size(), 1u);
    ASSERT_TRUE(scene.triangles[0].normals.has_value());
    EXPECT_EQ((*scene.triangles[0].normals)[0], glm::dvec3(0, 0, 1));
    EXPECT_EQ((*scene.triangles[0].normals)[1], glm::dvec3(0, 1, 0));
}

TEST(ParseNffScene, PolygonsWithoutAreaAreLeftOut) {
    const Scene scene = parse(
        "p 3\n0 0 0\n1 1 1\n2 2 2\np 4\n1 1 1\n1 1 1\n1 1 1\n1 1 1\n"
        "p 4\n0 0 0\n1 0 0\n2 0 0\n5 0 0\np 3\n0 0 0\n1 0 0\n0 1 0\n");
    EXPECT_EQ(scene.triangles.size(), 1u);
}

TEST(ParseNffScene, AFileWithoutAnyShapeLeftIsRefused) {
    for (const std::string lost :
         {"p 3 0 0 0 1 0 0 2 0 0", "pp 3 0 0 0 0 0 1 1 0 0 0 0 1 2 0 0 0 0 1", "c 0 0 0 1 0 0 0 1",
          "s 0 0 0 0"}) {
        EXPECT_EQ(refusal_of([&] { parse(lost); }).exit_code, ExitCode::input) << lost;
        EXPECT_EQ(parse("s 0 0 0 1\n" + lost).notes.size(), 1u) << lost;
    }
    EXPECT_EQ(parse("").notes.size(), 0u);
}

TEST(LoadScene, LightOverridesReplaceWhatIsLeftOpen) {
    const fs::path path = fs::temp_directory_path() / "mirrorball-light-override.NFF";
    std::ofstream(path) << view_text << "l 1 2 3\nl 1 2 3 0.5 0.5 0.5\n";
    LightOverrides light;
    light.light_scale = 2;
    light.ambient_light = glm::dvec3(0.1, 0.2, 0.3);
    const Scene scene = load_scene(path.string(), light);
    fs::remove(path);
    EXPECT_EQ(scene.lights[0].intensity, glm::dvec3(2));
    EXPECT_EQ(scene.lights[1].intensity, glm::dvec3(0.5));
    EXPECT_EQ(scene.ambient_light, glm::dvec3(0.1, 0.2, 0.3));
}

}  // namespace
}  // namespace rt::this_file
