// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/scene/geometry.h"
#include "host/scene/json_document.h"
#include "host/scene/mistakes.h"
#include "host/scene/scene_file.h"
#include "host/scene/words.h"
#include "tests/refusals.h"

namespace rt::this_file {
namespace {

namespace fs = std::filesystem;

const std::string camera_text =
    R"("camera": {"from": [0, 0, 5], "at": [0, 0, 0], "fov_degrees": 90})";

/// A scene with a camera and these additional members.
Scene parse_with(const std::string& members) {
    return parse_json_scene("{" + camera_text + (members.empty() ? "" : ",\n") + members + "}",
                            "some/where/test.json");
}

/// A 400 x 100 scene with only this camera.
Scene parse_camera(const std::string& members) {
    return parse_json_scene(
        R"({"image": {"width": 400, "height": 100}, "camera": {)" + members + "}}", "test.json");
}

Refusal refusal_of_text(const std::string& text) {
    return refusal_of([&] { parse_json_scene(text, "t.json"); });
}

void expect_near(const Scene::Window& window, double left, double right, double bottom,
                 double top) {
    EXPECT_NEAR(window.left, left, 1e-12);
    EXPECT_NEAR(window.right, right, 1e-12);
    EXPECT_NEAR(window.bottom, bottom, 1e-12);
    EXPECT_NEAR(window.top, top, 1e-12);
}

TEST(ParseJsonScene, BadFilesAreRefusedAsExpected) {
    const auto files = malformed_files(".json");
    EXPECT_GE(files.size(), 130u);
    for (const fs::path& path : files) {
        expect_announced(path, refusal_of([&] { load_scene(path.string()); }));
    }
}

TEST(ParseJsonScene, DefaultsAreTheDocumentedOnes) {
    const Scene scene = parse_with("");
    EXPECT_EQ(scene.name, "test");
    EXPECT_EQ(scene.width, 500);
    EXPECT_EQ(scene.height, 500);
    EXPECT_EQ(scene.aa, grid_aa(2));
    EXPECT_EQ(scene.max_bounces, 8);
    EXPECT_EQ(scene.background, glm::dvec3(0, 0, 0));
    EXPECT_EQ(scene.ambient_light, glm::dvec3(0, 0, 0));
    EXPECT_EQ(scene.camera.projection, Scene::Projection::perspective);
    EXPECT_EQ(scene.camera.up, glm::dvec3(0, 1, 0));
    EXPECT_TRUE(scene.lights.empty() && scene.spheres.empty() && scene.triangles.empty());
}

TEST(ParseJsonScene, MaterialsMayFollowTheShapes) {
    const Scene scene = parse_with(
        R"("spheres": [{"center": [1, 2, 3], "radius": 4, "material": "b"}],
           "materials": {"a": {}, "b": {"diffuse": 0.5, "mirror": [0.1, 0.2, 0.3]}})");
    ASSERT_EQ(scene.spheres.size(), 1u);
    EXPECT_EQ(scene.spheres[0].material, 1);
    EXPECT_EQ(scene.materials[1].name, "b");
    EXPECT_EQ(scene.materials[1].diffuse, glm::dvec3(0.5, 0.5, 0.5));
    EXPECT_EQ(scene.materials[1].mirror, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(scene.materials[1].shininess, 1);
    EXPECT_FALSE(scene.materials[1].two_sided);
}

TEST(ParseJsonScene, DuplicateAmongManyKeysIsNamed) {
    std::string materials;
    for (int i = 0; i < 30; ++i) materials += "\"m" + std::to_string(i) + "\": {},\n";
    const Refusal refusal =
        refusal_of_text("{" + camera_text + ",\"materials\": {\n" + materials + "\"m7\": {}}}");
    EXPECT_EQ(refusal.message, "t.json:32:1: key 'm7' is repeated, first at 9:1; keep one of them");
}

TEST(ParseJsonScene, AtMostTwentyMistakesAreReported) {
    std::string items = "1";
    for (int i = 0; i < 30; ++i) items += ",\n1";
    const Refusal refusal = refusal_of_text("{" + camera_text + ",\"lights\": [" + items + "]}");
    EXPECT_EQ(std::count(refusal.message.begin(), refusal.message.end(), '\n'), 19);
}

TEST(ParseJsonScene, CommentsAndByteOrderMarkAreAccepted) {
    const Scene scene = parse_json_scene(
        "\xEF\xBB\xBF// one\r\n/* two, [ */ { /**/ " + camera_text +
            ", // \"name\": \"no\"\n\"name\" /*:*/ : /* \" */ \"/* kept // \" } // end",
        "t.json");
    EXPECT_EQ(scene.name, "/* kept // ");
}

TEST(ParseJsonScene, PositionsAreRightBehindCommentsAndEscapes) {
    const Refusal refusal = refusal_of_text("{" + camera_text +
                                            ", \"name\": \"\\\\\\\" , // x\",\n"
                                            "/* a\n b */ \"max_bounces\" /* : */ : // c\n  2.5}");
    EXPECT_TRUE(refusal.message.starts_with("t.json:4:3: max_bounces is 2.5;")) << refusal.message;
}

TEST(ParseJsonScene, WholeNumberMayBeWrittenWithAPoint) {
    EXPECT_EQ(parse_with(R"("max_bounces": 2e1)").max_bounces, 20);
    EXPECT_EQ(parse_with(R"("max_bounces": 20.0)").max_bounces, 20);
}

TEST(ParseJsonScene, TinyNumbersAreKept) {
    const Scene scene = parse_with(
        R"("materials": {"m": {}},
           "spheres": [{"center": [5e-324, -1e30, 0], "radius": 1e-30, "material": "m"}])");
    EXPECT_EQ(scene.spheres[0].center, glm::dvec3(5e-324, -1e30, 0));
    EXPECT_EQ(scene.spheres[0].radius, 1e-30);
}

TEST(ParseJsonScene, VertexNormalsAreNormalizedAtAnyScale) {
    const Scene scene = parse_with(
        R"("materials": {"m": {}},
           "triangles": [{"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "material": "m",
                          "normals": [[0, 0, 1e-300], [3e29, 0, 4e29], [5e-324, 0, 0]]}])");
    const auto& normals = scene.triangles[0].normals;
    ASSERT_TRUE(normals);
    EXPECT_EQ((*normals)[0], glm::dvec3(0, 0, 1));
    EXPECT_NEAR((*normals)[1].x, 0.6, 1e-15);
    EXPECT_NEAR((*normals)[1].z, 0.8, 1e-15);
    EXPECT_EQ((*normals)[2], glm::dvec3(1, 0, 0));
}

TEST(ParseJsonScene, CameraAxesHoldAtAnyScale) {
    const std::string fov = R"("fov_degrees": 60, )";
    EXPECT_NO_THROW(parse_camera(fov + R"("from": [0, 0, 1e-30], "at": [0, 0, 0])"));
    EXPECT_NO_THROW(parse_camera(fov + R"("from": [0, 0, 1e30], "at": [0, 0, -1e30])"));
    EXPECT_NO_THROW(
        parse_camera(fov + R"("from": [0, 0, 1], "at": [0, 0, 0], "up": [0, 1e-300, 0])"));
    EXPECT_THROW(
        parse_camera(fov + R"("from": [0, 0, 1e-30], "at": [0, 0, 0], "up": [0, 0, 1e30])"), Error);
    EXPECT_THROW(parse_camera(fov + R"("from": [0, 0, 1e30], "at": [0, 0, 1e30])"), Error);
}

TEST(CameraWindow, FovSpansTheHeightByDefault) {
    const Scene scene = parse_camera(R"("from": [0, 0, 1], "at": [0, 0, 0], "fov_degrees": 90)");
    expect_near(scene.camera.window, -4, 4, -1, 1);
}

TEST(CameraWindow, FovOnXSpansTheWidth) {
    const Scene scene =
        parse_camera(R"("from": [0, 0, 1], "at": [0, 0, 0], "fov_degrees": 90, "fov_axis": "x")");
    expect_near(scene.camera.window, -1, 1, -0.25, 0.25);
}

TEST(CameraWindow, OrthographicExtentsAreSceneUnits) {
    const std::string text = R"("type": "orthographic", "from": [0, 0, 1], "at": [0, 0, 0], )";
    expect_near(parse_camera(text + R"("height": 3)").camera.window, -6, 6, -1.5, 1.5);
    expect_near(parse_camera(text + R"("width": 8)").camera.window, -4, 4, -1, 1);
    expect_near(parse_camera(text + R"("window": [1, 2, 3, 5])").camera.window, 1, 2, 3, 5);
}

TEST(CameraWindow, FollowsAnotherImageSizeUnlessGiven) {
    Scene scene = parse_camera(R"("from": [0, 0, 1], "at": [0, 0, 0], "fov_degrees": 90)");
    set_image_size(scene, 50, 100);
    EXPECT_EQ(scene.width, 50);
    expect_near(scene.camera.window, -0.5, 0.5, -1, 1);
    Scene fixed = parse_camera(R"("from": [0, 0, 1], "at": [0, 0, 0], "window": [-3, 1, -1, 2])");
    set_image_size(fixed, 50, 100);
    expect_near(fixed.camera.window, -3, 1, -1, 2);
}

TEST(LoadJsonScene, FileAboveTheSizeCapIsOverTheLimit) {
    const fs::path path =
        fs::temp_directory_path() / ("mirrorball-large-" + std::to_string(::getpid()) + ".json");
    std::ofstream(path) << "{}";
    fs::resize_file(path, (std::uintmax_t{256} << 20) + 1);  // sparse: takes no room
    const Refusal refusal = refusal_of([&] { load_scene(path.string()); });
    fs::remove(path);
    EXPECT_EQ(refusal.exit_code, ExitCode::limit);
    EXPECT_NE(refusal.message.find("larger than 256 MiB"), std::string::npos);
}

TEST(ZeroArea, ThinTriangleIsKept) {
    EXPECT_FALSE(zero_area({glm::dvec3(0, 0, 0), glm::dvec3(1, 0, 0), glm::dvec3(0.5, 1e-12, 0)}));
    EXPECT_FALSE(
        zero_area({glm::dvec3(1, 1, 1), glm::dvec3(1 + 1e-9, 1, 1), glm::dvec3(1, 1 + 1e-9, 1)}));
}

TEST(ZeroArea, ScaleDoesNotMatter) {
    for (const double s : {1e-300, 1e-30, 1.0, 1e30}) {
        EXPECT_FALSE(zero_area({glm::dvec3(0, 0, 0), glm::dvec3(s, 0, 0), glm::dvec3(0, s, 0)}));
        EXPECT_TRUE(zero_area({glm::dvec3(0, 0, 0), glm::dvec3(s, s, s), glm::dvec3(3 * s)}));
    }
    EXPECT_FALSE(
        zero_area({glm::dvec3(1e30, 0, 0), glm::dvec3(1e30, 1, 0), glm::dvec3(1e30, 0, 1e-30)}));
}

TEST(ParseJsonScene, KeysAreGuessed) {
    const auto advice = [](const std::string& scene) {
        return refusal_of([&] { parse_json_scene(scene, "t.json"); }).message;
    };
    const std::string view = R"("from": [0, 0, 5], "at": [0, 0, 0])";
    for (const auto& [scene, meant] :
         {std::pair<std::string, std::string>{R"({"camera": {)" + view + R"(, "fov": 40}})",
                                              "fov_degrees"},
          {R"({"bounces": 3})", "max_bounces"},
          {R"({"ambient": 3})", "ambient_light"}}) {
        EXPECT_NE(advice(scene).find("did you mean '" + meant + "'?"), std::string::npos)
            << advice(scene);
    }
}

TEST(NearestWord, FindsTyposAndNothingElse) {
    constexpr std::string_view known[] = {"center", "radius", "material"};
    EXPECT_EQ(nearest_word("centre", known), "center");
    EXPECT_EQ(nearest_word("Radius", known), "radius");
    EXPECT_EQ(nearest_word("mateiral", known), "material");
    EXPECT_EQ(nearest_word("colour", known), "");
}

TEST(InQuotes, ControlCharactersAreSpelledOut) {
    EXPECT_EQ(in_quotes("a\x1b[2J\n\xC2\x9B"), "'a\\x1b[2J\\x0a\\xc2\\x9b'");
    EXPECT_EQ(in_quotes("\xC3\xA4"), "'\xC3\xA4'");
    EXPECT_EQ(in_quotes(std::string(100, 'x')), "'" + std::string(60, 'x') + "...'");
}

TEST(PositionOf, ColumnsCountCharacters) {
    EXPECT_EQ(position_of("\xEF\xBB\xBF{\n\xC3\xA4\xE2\x82\xAC!", 10), "2:3");
}

TEST(PositionOf, EveryLineEndCounts) {
    const std::string text = "a\r\rb\r\nc\n\rd";
    const std::vector<std::string> expected{"1:1", "1:2", "2:1", "3:1", "3:2", "3:3",
                                            "4:1", "4:2", "5:1", "6:1", "6:2"};
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(position_of(text, i), expected[i]) << i;
    }
}

/// The warnings for a scene seen from (0, 0, 5) along -z, 40 degrees wide.
std::vector<std::string> warnings_for(const std::string& keys,
                                      const std::string& view = R"("fov_degrees": 40)") {
    return scene_warnings(parse_json_scene(
        R"({"camera": {"from": [0, 0, 5], "at": [0, 0, 0], )" + view + "}, " + keys + "}",
        "t.json"));
}

std::string ball_at(const std::string& center, const std::string& material) {
    return R"("materials": {"m": )" + material + R"(}, "spheres": [{"center": )" + center +
           R"(, "radius": 1, "material": "m"}])";
}

bool warns(const std::vector<std::string>& warnings, const std::string& words) {
    return std::any_of(warnings.begin(), warnings.end(), [&](const std::string& warning) {
        return warning.find(words) != warning.npos;
    });
}

TEST(ParseJson, ReadsWhatRfc8259Has) {
    const std::string text =
        R"({"a": [0, -0, -0.0, 1e3, 12345678901234567890, 1e-999, true, false, null],
            "\"\\\/\b\f\n\r\t\u00e4\u20ac\ud83d\ude00": {}} // end)";
    Mistakes mistakes(text, "t.json");
    const JsonValue root = parse_json(mistakes);
    const auto& members = *root.as<JsonValue::Object>();
    ASSERT_EQ(members.size(), 2u);
    EXPECT_EQ(members[1].key, "\"\\/\b\f\n\r\t\u00e4\u20ac\U0001F600");
    const auto& items = *members[0].value.as<JsonValue::Array>();
    const double numbers[] = {0, 0, -0.0, 1000, 12345678901234567890.0, 0};
    for (std::size_t i = 0; i < std::size(numbers); ++i) {
        EXPECT_EQ(std::bit_cast<std::uint64_t>(*items[i].as<double>()),
                  std::bit_cast<std::uint64_t>(numbers[i]));
    }
    EXPECT_EQ(items[3].offset, 20u);
    EXPECT_TRUE(*items[6].as<bool>());
    EXPECT_FALSE(*items[7].as<bool>());
    EXPECT_TRUE(items[8].as<std::monostate>());
}

TEST(SceneWarnings, NoLightAtAll) {
    const std::string dark = "no light reaches any surface";
    const std::string matt = ball_at("[0, 0, 0]", R"({"diffuse": 0.5})");
    EXPECT_TRUE(warns(warnings_for(matt), dark));
    EXPECT_TRUE(warns(warnings_for(matt + R"(, "ambient_light": 1)"), dark));
    EXPECT_TRUE(warns(
        warnings_for(matt + R"(, "lights": [{"position": [0, 9, 0], "intensity": 0}])"), dark));
    EXPECT_TRUE(warnings_for(matt + R"(, "lights": [{"position": [0, 9, 0]}])").empty());
    EXPECT_TRUE(
        warnings_for(ball_at("[0, 0, 0]", R"({"ambient": 0.5})") + R"(, "ambient_light": 1)")
            .empty());
    EXPECT_TRUE(
        warnings_for(ball_at("[0, 0, 0]", R"({"mirror": 0.5})") + R"(, "background": 1)").empty());
    EXPECT_TRUE(warnings_for(R"("background": 0)").empty());
}

TEST(SceneWarnings, NothingInView) {
    const std::string light = R"(, "ambient_light": 1, )";
    const std::string words = "nothing is in view";
    const std::string gray = R"({"ambient": 1})";
    for (const std::string center : {"[0, 0, 7]", "[4, 0, 0]", "[0, -4, 0]", "[9, 9, -9]"}) {
        EXPECT_TRUE(warns(warnings_for(ball_at(center, gray) + R"(, "ambient_light": 1)"), words))
            << center;
    }
    for (const std::string center :
         {"[0, 0, 5.5]", "[2.7, 0, 0]", "[0, 0, -1000]", "[30, 0, -100]"}) {
        EXPECT_TRUE(warnings_for(ball_at(center, gray) + R"(, "ambient_light": 1)").empty())
            << center;
    }
    const std::string path = R"(, "ambient_light": 1, "path": {"keys": [{"frame": 1}]})";
    EXPECT_TRUE(warnings_for(ball_at("[0, 0, 7]", gray) + path).empty());
    const std::string ortho = R"("type": "orthographic", "window": [1, 3, -1, 1])";
    EXPECT_TRUE(
        warnings_for(ball_at("[2, 0, 0]", gray) + R"(, "ambient_light": 1)", ortho).empty());
    EXPECT_TRUE(warns(
        warnings_for(ball_at("[-0.5, 0, 0]", gray) + R"(, "ambient_light": 1)", ortho), words));
    const std::string skin = R"("materials": {"m": {"ambient": 1}})" + light;
    const auto triangle = [&](const std::string& vertices) {
        return skin + R"("triangles": [{"material": "m", "vertices": )" + vertices + "}]";
    };
    EXPECT_TRUE(warnings_for(triangle("[[-50, -50, 0], [50, -50, 0], [0, 99, 0]]")).empty());
    EXPECT_TRUE(warns(warnings_for(triangle("[[5, 0, 0], [6, 0, 0], [5, 1, 0]]")), words));
    const std::string cone = R"("cones": [{"material": "m", "base_radius": 1, "apex_radius": 0, )";
    EXPECT_TRUE(warnings_for(skin + cone + R"("base": [9, 0, 0], "apex": [0, 0, 0]}])").empty());
    EXPECT_TRUE(
        warns(warnings_for(skin + cone + R"("base": [9, 0, 0], "apex": [5, 0, 0]}])"), words));
}

TEST(SceneWarnings, ColorsOfBytesAndMirrorsThatBrighten) {
    const std::string lit = R"(, "ambient_light": 1)";
    const std::string bytes = "looks like 0 to 255";
    const auto of = [&](const std::string& material) {
        return warnings_for(ball_at("[0, 0, 0]", material) + lit);
    };
    EXPECT_TRUE(warns(of(R"({"ambient": [255, 128, 0], "diffuse": 200})"),
                      "ambient of material 'm': " + bytes));
    EXPECT_TRUE(warns(warnings_for(ball_at("[0, 0, 0]", R"({"ambient": 1})") + lit +
                                   R"(, "background": [135, 206, 235])"),
                      bytes));
    EXPECT_TRUE(of(R"({"ambient": 1, "diffuse": [1, 0, 1], "specular": 2.5})").empty());
    EXPECT_TRUE(of(R"({"ambient": [4, 4, 5], "diffuse": 16})").empty());
    EXPECT_TRUE(
        warns(of(R"({"ambient": 1, "mirror": [0, 1.5, 0]})"), "mirror of material 'm': exceeds 1"));
    EXPECT_TRUE(of(R"({"ambient": 1, "mirror": 1, "transmission": 1})").empty());
}

TEST(Printable, LettersStayAsTheyAre) {
    for (const std::string text : {"", "plain name.json", "Gr\u00f6\u00dfe", "\u65e5\u672c\u8a9e",
                                   "\u05e9\u05dc\u05d5\u05dd", "\u0627\u0644", "e\u0301",
                                   "\U0001F600", "back\\slash", "\u2200x \u2264 y"}) {
        EXPECT_EQ(printable(text), text);
    }
}

TEST(Printable, WhatATerminalObeysIsEscaped) {
    EXPECT_EQ(printable("a\nb\r\t\x1b[31m\x7f"), "a\\x0ab\\x0d\\x09\\x1b[31m\\x7f");
    EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
    EXPECT_EQ(printable("\x9b"
                        "31m"),
              "\\x9b31m");  // CSI, 8 bits
    EXPECT_EQ(printable("\xc2\x9b"
                        "31m"),
              "\\xc2\\x9b31m");  // the same in UTF-8
    EXPECT_EQ(printable("\u202egnp.\u2066"), "\\xe2\\x80\\xaegnp.\\xe2\\x81\\xa6");
    EXPECT_EQ(printable("\u2028\ufeff"), "\\xe2\\x80\\xa8\\xef\\xbb\\xbf");
    EXPECT_EQ(printable("\xff\xc3"), "\\xff\\xc3");  // not UTF-8
    EXPECT_EQ(printable("\xc3\u00f6"), "\\xc3\u00f6");
    EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");                    // overlong
    EXPECT_EQ(printable("\xe0\x9f\xbf"), "\\xe0\\x9f\\xbf");           // overlong
    EXPECT_EQ(printable("\xf0\x8f\xbf\xbf"), "\\xf0\\x8f\\xbf\\xbf");  // overlong
    EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // a surrogate
    EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // U+110000
    EXPECT_EQ(printable("\xf8\x88\x80\x80\x80"), "\\xf8\\x88\\x80\\x80\\x80");
    EXPECT_EQ(printable("\xe2\x82"), "\\xe2\\x82");  // cut off
    EXPECT_EQ(printable("\xf4\x8f\xbf\xbd"), "\xf4\x8f\xbf\xbd");
}

TEST(ParseJsonScene, MessagesShowNoBytesOfFileNamesThatTerminalsObey) {
    for (const std::string ending : {".json", ".nff", ".obj", ".ply"}) {
        const std::string name = "no\n\x1b[31m\x9b\u202e\u00f6" + ending;
        const Refusal refusal = refusal_of([&] { load_scene(name); });
        EXPECT_EQ(refusal.message, "no\\x0a\\x1b[31m\\x9b\\xe2\\x80\\xae\u00f6" + ending +
                                       ": no such file; check the path");
    }
}

}  // namespace
}  // namespace rt::this_file
