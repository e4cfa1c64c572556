// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "host/error.h"
#include "host/scene/nff_file.h"
#include "host/scene/orientation.h"
#include "host/scene/polygon.h"
#include "host/scene/scene_file.h"

namespace rt {
namespace {

namespace fs = std::filesystem;

using Face = std::array<std::uint32_t, 3>;

const std::string view_text =
    "v\nfrom 1 2 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 64 32\n";

Scene parse(const std::string& entities) {
    return parse_nff_scene(view_text + entities, "some/where/test.nff");
}

struct Refusal {
    ExitCode exit_code = ExitCode::done;
    std::string message;
};

template <class F>
Refusal refusal_of(F action) {
    try {
        action();
    } catch (const Error& error) {
        return {error.exit_code(), error.what()};
    }
    return {};
}

/// "line:column: text" from the leading `# expect` lines, or from the .expect file beside.
std::vector<std::string> expectations(fs::path path) {
    std::vector<std::string> result;
    std::ifstream file(path);
    const std::string mark = "# expect ";
    for (std::string line; std::getline(file, line) && line.starts_with(mark);) {
        result.push_back(line.substr(mark.size()));
    }
    std::ifstream beside(path.replace_extension(".expect"));
    for (std::string line; std::getline(beside, line);) result.push_back(line);
    return result;
}

TEST(ParseNffScene, BadFilesAreRefusedAsExpected) {
    int files = 0;
    for (const auto& entry : fs::directory_iterator(MIRRORBALL_BAD_SCENES_DIR)) {
        const fs::path& path = entry.path();
        if (path.extension() != ".nff") continue;
        ++files;
        SCOPED_TRACE(path.string());
        const Refusal refusal = refusal_of([&] { load_scene(path.string()); });
        EXPECT_EQ(refusal.exit_code, ExitCode::input);
        const auto expected = expectations(path);
        EXPECT_FALSE(expected.empty());
        for (const std::string& text : expected) {
            const std::string line = path.string() + ":" + text;
            EXPECT_NE(refusal.message.find(line), std::string::npos)
                << "expected " << line << "\nbut got  " << refusal.message;
        }
        const auto lines = std::count(refusal.message.begin(), refusal.message.end(), '\n') + 1;
        EXPECT_EQ(static_cast<std::size_t>(lines), expected.size()) << refusal.message;
    }
    EXPECT_GE(files, 50);
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

TEST(ParseNffScene, LightsWithoutColourShareTheLight) {
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

TEST(ParseNffScene, LightColoursAreTakenAsGivenAndCount) {
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

TEST(Orientation, IsExactWhereRoundingWouldNotBe) {
    const double ulp = std::ldexp(1.0, -53);
    EXPECT_EQ(orientation({0.5, 0.5}, {12, 12}, {24, 24}), 0);
    EXPECT_EQ(orientation({0.5, 0.5 + ulp}, {12, 12}, {24, 24}), 1);
    EXPECT_EQ(orientation({0.5 + ulp, 0.5}, {12, 12}, {24, 24}), -1);
    EXPECT_EQ(orientation({0, 0}, {1, 0}, {0.5, 1e-300}), 1);
}

double area_of(const std::vector<glm::dvec3>& corners, const Face& face) {
    const auto [a, b, c] = face;
    return glm::cross(corners[b] - corners[a], corners[c] - corners[a]).z / 2;
}

/// Triangulates a polygon in z = 0, which must go well: all parts face up and add up to `area`.
std::vector<Face> expect_split(const std::vector<glm::dvec3>& corners, double area) {
    std::int64_t work = max_polygon_work;
    std::vector<Face> faces;
    EXPECT_EQ(triangulate(corners, work, faces), PolygonFault::none);
    double sum = 0;
    for (const Face& face : faces) {
        EXPECT_GT(area_of(corners, face), 0);
        sum += area_of(corners, face);
    }
    EXPECT_NEAR(sum, area, 1e-12 * std::abs(area));
    return faces;
}

std::vector<glm::dvec3> ring_of(int corners, double inner, double outer) {
    std::vector<glm::dvec3> ring;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        const double radius = i % 2 == 0 ? outer : inner;
        ring.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    return ring;
}

TEST(Triangulate, ConvexPolygon) {
    const auto ring = ring_of(100, 1, 1);
    EXPECT_EQ(expect_split(ring, 50 * std::sin(2 * std::numbers::pi / 100)).size(), 98u);
}

TEST(Triangulate, StarsOfAnySize) {
    for (const int corners : {6, 10, 144, 1000}) {
        const auto ring = ring_of(corners, 0.3, 1);
        const double area = 0.5 * 0.3 * corners * std::sin(2 * std::numbers::pi / corners);
        EXPECT_EQ(expect_split(ring, area).size(), ring.size() - 2);
    }
}

TEST(Triangulate, CornersOnAnEdgeBecomeCornersOfTriangles) {
    const auto faces = expect_split({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, 4);
    EXPECT_EQ(faces.size(), 3u);
}

TEST(Triangulate, ManyCornersOnAnEdge) {
    std::vector<glm::dvec3> corners{{0, 5, 0}};
    for (int i = 0; i <= 5000; ++i) corners.emplace_back(i, 0, 0);
    EXPECT_EQ(expect_split(corners, 5000 * 5 / 2.0).size(), 5000u);
}

TEST(Triangulate, HoleJoinedByASlit) {
    expect_split({{0, 0, 0},
                  {4, 0, 0},
                  {4, 4, 0},
                  {0, 4, 0},
                  {0, 0, 0},
                  {1, 1, 0},
                  {1, 3, 0},
                  {3, 3, 0},
                  {3, 1, 0},
                  {1, 1, 0}},
                 12);
}

TEST(Triangulate, CornersThatTouchAnEdge) {
    expect_split({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}}, 8);
}

TEST(Triangulate, RepeatedCornersAndSpikes) {
    expect_split({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}}, 1);
    expect_split({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 1);
}

TEST(Triangulate, AnyScaleAndPlace) {
    for (const double scale : {1e-30, 1e-12, 1.0, 1e12, 1e29}) {
        std::vector<glm::dvec3> ring = ring_of(20, 0.5, 1);
        for (glm::dvec3& corner : ring) corner *= scale;
        const double area = 5 * std::sin(2 * std::numbers::pi / 20) * scale * scale;
        expect_split(ring, area);
    }
}

TEST(Triangulate, BackOfAPolygonStaysItsBack) {
    std::vector<glm::dvec3> ring = ring_of(12, 0.5, 1);
    std::reverse(ring.begin(), ring.end());
    std::int64_t work = max_polygon_work;
    std::vector<Face> faces;
    ASSERT_EQ(triangulate(ring, work, faces), PolygonFault::none);
    for (const Face& face : faces) EXPECT_LT(area_of(ring, face), 0);
}

TEST(Triangulate, FaultsAreNamed) {
    const auto fault_of = [](const std::vector<glm::dvec3>& corners, std::int64_t work) {
        std::vector<Face> faces;
        return triangulate(corners, work, faces);
    };
    EXPECT_EQ(fault_of({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, max_polygon_work),
              PolygonFault::crosses_itself);
    EXPECT_EQ(fault_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}}, max_polygon_work),
              PolygonFault::bent);
    EXPECT_EQ(fault_of({{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {3, 3, 0}}, max_polygon_work),
              PolygonFault::zero_area);
    EXPECT_EQ(fault_of(ring_of(1000, 0.3, 1), 1000), PolygonFault::too_intricate);
}

}  // namespace
}  // namespace rt
