// SPDX-License-Identifier: Apache-2.0
//
// A scene file in which one number is NaN, infinite, subnormal or huge is refused, or rendered
// without a NaN.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "host/base/error.h"
#include "host/render/threads_renderer.h"
#include "host/scene/scene_file.h"
#include "tests/whole_film.h"

namespace rt::this_file {
namespace {

/// Each number between two @ can be replaced.
constexpr const char* scene_text = R"({"camera": {"from": [@0@, 1, 6], "at": [0, @0@, 0],
"up": [0, @1@, 0.125], "fov_degrees": @40@}, "image": {"width": 12, "height": 9, "aa": "none"},
"max_bounces": @4@, "background": [@0.25@, 0, 0.5], "ambient_light": [@0.25@, 0, 0.25],
"lights": [{"position": [3, @2@, 4], "intensity": [@0.5@, 0, 0.5]}],
"materials": {"skin": {"ambient": [@0.5@, 0, 0.5], "diffuse": [@0.5@, 0, 0.5],
"specular": [@0.5@, 0, 0.5], "mirror": [@0.5@, 0, 0.5], "shininess": @20@},
"glass": {"transmission": [@0.5@, 0, 0.5], "ior": @1.5@}},
"cones": [{"base": [@1@, -1, 1], "base_radius": @0.5@, "apex": [1.5, @2@, 0.5],
"apex_radius": @0.25@, "material": "glass"}],
"spheres": [{"center": [@0@, 0, 0], "radius": @1@, "material": "skin"},
{"center": [-1, 1, -1], "radius": 0.75, "material": "skin"}],
"triangles": [{"vertices": [[-3, -1, 2], [3, -1, 2], [0, @2@, -3]],
"normals": [[0, 1, @0.25@], [0.25, 1, 0], [0, 1, -0.25]], "material": "skin"}]})";

/// The scene's text in pieces: every other one is a number.
std::vector<std::string> pieces() {
    std::vector<std::string> all(1);
    for (const char c : std::string(scene_text)) {
        if (c == '@') {
            all.emplace_back();
        } else {
            all.back() += c;
        }
    }
    return all;
}

std::string joined(const std::vector<std::string>& parts) {
    std::string text;
    for (const std::string& part : parts) text += part;
    return text;
}

template <typename T>
bool has_nan(const Scene& scene) {
    const FlatScene<T> flat = flatten<T>(scene);
    const Film<T> film = whole_film(*make_threads_renderer(flat, {}), scene.width, scene.height);
    return std::any_of(film.rgb.begin(), film.rgb.end(), [](T x) { return std::isnan(x); });
}

/// Whether the scene is rendered, not refused.
bool renders(const std::string& text) {
    try {
        const Scene scene = parse_json_scene(text, "odd.json");
        EXPECT_FALSE(has_nan<float>(scene)) << text;
        EXPECT_FALSE(has_nan<double>(scene)) << text;
        return true;
    } catch (const Error& error) {
        EXPECT_EQ(error.exit_code(), ExitCode::input) << error.what() << text;
        return false;
    }
}

TEST(OddNumbers, AreRefusedOrGiveNoNaN) {
    int rendered = 0;
    const std::vector<std::string> ordinary = pieces();
    ASSERT_TRUE(renders(joined(ordinary)));
    for (std::size_t i = 1; i < ordinary.size(); i += 2) {
        for (const char* number :
             {"NaN", "Infinity", "1e999", "-1e308", "1e31", "1e30", "-1e30", "1e15", "1e-15",
              "1e-30", "1e-38", "1e-45", "1e-320", "5e-324", "1e-999", "0", "-0", "-1e-30"}) {
            std::vector<std::string> parts = ordinary;
            parts[i] = number;
            rendered += renders(joined(parts)) ? 1 : 0;
        }
    }
    EXPECT_GT(rendered, 100);
}

TEST(OddNumbers, OfRandomBitsGiveNoNaN) {
    std::mt19937_64 engine(1);
    int rendered = 0;
    for (int i = 0; i < 200; ++i) {
        std::vector<std::string> parts = pieces();
        for (std::uint64_t k = 1 + engine() % 3; k > 0; --k) {
            const double fraction = 1 + static_cast<double>(engine() >> 12) * 0x1p-52;
            const int exponent = static_cast<int>(engine() % 160) - 80;
            parts[1 + 2 * (engine() % (parts.size() / 2))] =
                fmt::format("{:.17g}", std::ldexp(fraction, exponent));
        }
        rendered += renders(joined(parts)) ? 1 : 0;
    }
    EXPECT_GT(rendered, 20);
}

TEST(OddNumbers, CamerasAndShapesWithoutSizeAreRefusedOrGiveNoNaN) {
    const std::string start = R"({"materials": {"m": {"ambient": 1}}, "ambient_light": 1,
"image": {"width": 12, "height": 9}, )";
    for (const char* camera :
         {R"("from": [1, 2, 3], "at": [1, 2, 3])", R"("from": [0, 5, 0], "at": [0, 0, 0])",
          R"("from": [0, 5, 0], "at": [0, 0, 0], "up": [0, 0, 0])",
          R"("from": [1e30, 0, 1e30], "at": [1e30, 0, 0])"}) {
        renders(start + R"("camera": {"fov_degrees": 40, )" + camera +
                R"(}, "spheres": [{"center": [0, 0, 0], "radius": 1, "material": "m"}]})");
    }
    const std::string seen = start + R"("camera": {"from": [0, 0, 5], "at": [0, 0, 0],
"fov_degrees": 40}, )";
    for (const char* triangle :
         {"[0,0,0],[0,0,0],[0,0,0]", "[0,0,0],[1,1,1],[2,2,2]", "[0,0,0],[1e-30,0,0],[0,1e-30,0]",
          "[0,0,0],[1,1,1],[3,3,3.0000000000000004]", "[-1,-1,0],[1,-1,0],[0,1e-300,0]",
          "[-1e30,-1e30,0],[1e30,-1e30,0],[0,1e30,0]"}) {
        renders(seen + R"("triangles": [{"material": "m", "vertices": [)" + triangle + "]}]}");
    }
    for (const char* cone : {R"("base_radius": 1, "apex": [0,0,0], "apex_radius": 1)",
                             R"("base_radius": 0, "apex": [0,1,0], "apex_radius": 0)",
                             R"("base_radius": 1, "apex": [0,1e-30,0], "apex_radius": 0.5)",
                             R"("base_radius": 1e-30, "apex": [0,1,0], "apex_radius": 1e30)"}) {
        renders(seen + R"("cones": [{"material": "m", "base": [0,0,0], )" + cone + "}]}");
    }
}

}  // namespace
}  // namespace rt::this_file
