// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "host/stress/families.h"

namespace rt {

namespace {

using Fields = std::map<std::string, std::string>;

/// The numbers of a small scene, by name, as written in a file.
const Fields& ordinary_fields() {
    static const Fields fields{{"from", "0"},
                               {"at", "0"},
                               {"up", "1"},
                               {"fov", "40"},
                               {"ambient", "0.5"},
                               {"diffuse", "0.5"},
                               {"specular", "0.5"},
                               {"mirror", "0.5"},
                               {"shininess", "20"},
                               {"background", "0.25"},
                               {"ambient-light", "0.25"},
                               {"light-position", "2"},
                               {"light-intensity", "0.5"},
                               {"center", "0"},
                               {"radius", "1"},
                               {"vertex", "2"},
                               {"normal", "0.25"},
                               {"bounces", "4"},
                               {"window", "-1"},
                               {"transmission", "0.5"},
                               {"ior", "1.5"},
                               {"cone-base", "1"},
                               {"cone-apex", "2"},
                               {"cone-base-radius", "0.5"},
                               {"cone-apex-radius", "0.25"}};
    return fields;
}

std::string scene_text(const Fields& f, bool with_window) {
    const std::string view = with_window ? fmt::format("\"window\": [{}, 1, -1, 1]", f.at("window"))
                                         : fmt::format("\"fov_degrees\": {}", f.at("fov"));
    return fmt::format(
        R"({{"camera": {{"from": [{}, 1, 6], "at": [0, {}, 0], "up": [0, {}, 0.125], {}}},
"image": {{"width": 12, "height": 9, "aa": "none"}}, "max_bounces": {}, "background": [{}, 0, 0.5],
"ambient_light": [{}, 0, 0.25],
"lights": [{{"position": [3, {}, 4], "intensity": [{}, 0, 0.5]}}],
"materials": {{"skin": {{"ambient": [{}, 0, 0.5], "diffuse": [{}, 0, 0.5],
"specular": [{}, 0, 0.5], "mirror": [{}, 0, 0.5], "shininess": {}}},
"glass": {{"transmission": [{}, 0, 0.5], "ior": {}}}}},
"cones": [{{"base": [{}, -1, 1], "base_radius": {}, "apex": [1.5, {}, 0.5], "apex_radius": {},
"material": "glass"}}],
"spheres": [{{"center": [{}, 0, 0], "radius": {}, "material": "skin"}},
{{"center": [-1, 1, -1], "radius": 0.75, "material": "skin"}}],
"triangles": [{{"vertices": [[-3, -1, 2], [3, -1, 2], [0, {}, -3]],
"normals": [[0, 1, {}], [0.25, 1, 0], [0, 1, -0.25]], "material": "skin"}}]}})",
        f.at("from"), f.at("at"), f.at("up"), view, f.at("bounces"), f.at("background"),
        f.at("ambient-light"), f.at("light-position"), f.at("light-intensity"), f.at("ambient"),
        f.at("diffuse"), f.at("specular"), f.at("mirror"), f.at("shininess"), f.at("transmission"),
        f.at("ior"), f.at("cone-base"), f.at("cone-base-radius"), f.at("cone-apex"),
        f.at("cone-apex-radius"), f.at("center"), f.at("radius"), f.at("vertex"), f.at("normal"));
}

constexpr const char* odd_numbers[] = {
    "NaN",    "Infinity", "-Infinity", "1e999", "-1e999", "1e308", "-1e308", "1e31",
    "1e30",   "-1e30",    "1e15",      "1e-15", "1e-30",  "1e-38", "1e-45",  "1e-308",
    "1e-320", "5e-324",   "1e-999",    "0",     "-0",     "-1e-30"};

StressFamily odd_fields() {
    const std::set<std::string> quick{"mirror", "radius", "vertex", "ior", "cone-apex-radius"};
    std::vector<LabeledCase> cases;
    for (const auto& [name, usual] : ordinary_fields()) {
        std::vector<std::string> texts;
        for (const char* number : odd_numbers) {
            Fields fields = ordinary_fields();
            fields[name] = number;
            texts.push_back(scene_text(fields, name == "window"));
        }
        cases.push_back(
            {name, quick.contains(name) ? InQuick::yes : InQuick::no, text_case(texts)});
    }
    return listed(
        {"odd-numbers", "field",
         "NaN, infinities, subnormal and huge numbers: refused, or rendered without a NaN"},
        cases);
}

/// A number from random bits of a double or a float, or of moderate size.
std::string random_number(std::mt19937_64& engine) {
    const std::uint64_t bits = engine();
    switch (engine() % 3) {
        case 0:
            return fmt::format("{:.17g}", std::bit_cast<double>(bits));
        case 1:
            return fmt::format("{:.17g}", std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
        default:
            return fmt::format("{:.17g}", std::ldexp(1 + static_cast<double>(bits >> 12) * 0x1p-52,
                                                     static_cast<int>(engine() % 160) - 80));
    }
}

/// Ordinary scenes with up to three fields (never "bounces") replaced by random numbers.
std::vector<std::string> random_texts(unsigned seed) {
    std::mt19937_64 engine(seed);
    std::vector<std::string> texts;
    for (int i = 0; i < 40; ++i) {
        Fields fields = ordinary_fields();
        const std::uint64_t changes = 1 + engine() % 3;
        for (std::uint64_t k = 0; k < changes; ++k) {
            auto field = fields.begin();
            std::advance(field, static_cast<std::ptrdiff_t>(engine() % fields.size()));
            if (field->first != "bounces") field->second = random_number(engine);
        }
        texts.push_back(scene_text(fields, i % 4 == 0));
    }
    return texts;
}

StressFamily random_bits() {
    return sweep({"random-bits", "seed", "several implausible numbers at once"},
                 {1, 2, 3, 4, 5, 6, 7, 8}, {1},
                 [](int seed) { return text_case(random_texts(seed)); });
}

/// A ball seen by this camera.
std::string camera_text(const char* camera) {
    return fmt::format(R"({{"camera": {{{}}}, "image": {{"width": 12, "height": 9}},
"materials": {{"m": {{"ambient": 1}}}}, "ambient_light": 1,
"spheres": [{{"center": [0, 0, 0], "radius": 1, "material": "m"}}]}})",
                       camera);
}

std::string shape_text(const std::string& shapes) {
    return fmt::format(R"({{"camera": {{"from": [0, 0, 5], "at": [0, 0, 0], "fov_degrees": 40}},
"image": {{"width": 12, "height": 9}}, "materials": {{"m": {{"ambient": 1}}}},
"ambient_light": 1, {}}})",
                       shapes);
}

std::string triangle_text(const char* vertices) {
    return shape_text(
        fmt::format(R"("triangles": [{{"vertices": [{}], "material": "m"}}])", vertices));
}

std::string sphere_text(const char* radius) {
    return shape_text(fmt::format(
        R"("spheres": [{{"center": [0,0,0], "radius": {}, "material": "m"}}])", radius));
}

std::string cone_text(const char* base_radius, const char* apex, const char* apex_radius) {
    return shape_text(fmt::format(R"("cones": [{{"base": [0,0,0], "base_radius": {}, "apex": {},
"apex_radius": {}, "material": "m"}}])",
                                  base_radius, apex, apex_radius));
}

/// Cameras without axes and triangles without area.
StressFamily no_geometry() {
    return listed(
        {"no-geometry", "what is missing",
         "views without axes, triangles without area, spheres without size"},
        {{"cameras", InQuick::yes,
          text_case(
              {camera_text(R"("from": [1, 2, 3], "at": [1, 2, 3], "fov_degrees": 40)"),
               camera_text(R"("from": [0, 5, 0], "at": [0, 0, 0], "fov_degrees": 40)"),
               camera_text(
                   R"("from": [0, 5, 0], "at": [0, 0, 0], "up": [0, 0, 0], "fov_degrees": 40)"),
               camera_text(R"("from": [0, 0, 5], "at": [0, 0, 0], "fov_degrees": 0)"),
               camera_text(R"("from": [0, 0, 5], "at": [0, 0, 0], "fov_degrees": 180)"),
               camera_text(
                   R"("from": [0, 0, 5], "at": [0, 0, 0], "fov_degrees": 179.999999999999)"),
               camera_text(R"("from": [0, 0, 5], "at": [0, 0, 0], "fov_degrees": 1e-300)"),
               camera_text(R"("from": [1e30, 0, 1e30], "at": [1e30, 0, 0], "fov_degrees": 40)")})},
         {"shapes", InQuick::yes,
          text_case({triangle_text("[0,0,0],[0,0,0],[0,0,0]"),
                     triangle_text("[0,0,0],[1,1,1],[2,2,2]"),
                     triangle_text("[0,0,0],[1,1,1],[3,3,3.0000000000000004]"),
                     triangle_text("[0,0,0],[1e-30,0,0],[0,1e-30,0]"),
                     triangle_text("[-1e30,-1e30,0],[1e30,-1e30,0],[0,1e30,0]"),
                     triangle_text("[-1,-1,0],[1,-1,0],[0,1e-300,0]"), sphere_text("1e-30"),
                     sphere_text("1e30"), cone_text("1", "[0,0,0]", "1"),
                     cone_text("0", "[0,1,0]", "0"), cone_text("1", "[0,1e-30,0]", "0.5"),
                     cone_text("1e-30", "[0,1,0]", "1e30"), shape_text(R"("spheres": [])")})}});
}

}  // namespace

StressFamilies input_families() { return {odd_fields(), random_bits(), no_geometry()}; }

}  // namespace rt
