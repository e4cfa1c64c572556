// SPDX-License-Identifier: Apache-2.0
#include <glm/geometric.hpp>

#include "host/scene/json_file.h"
#include "host/stress/case_helpers.h"
#include "host/stress/families.h"
#include "host/stress/meshes.h"
#include "host/stress/stress_scenes.h"

namespace rt {

namespace {

/// A ball of 80 faces with the normals of the sphere, seen from outside.
Scene smooth_ball(double mirror) {
    Scene scene = bare_scene();
    const int skin = add_matt(scene, {0.75, 0.5, 0.25}, 0.25, 20);
    scene.materials.back().mirror = glm::dvec3(mirror);
    add_floor(scene, {0, -1.25, 0}, 12, add_matt(scene, glm::dvec3(0.5)));
    const std::size_t first = scene.triangles.size();
    add_mesh(scene, ball_mesh(1), skin);
    for (std::size_t i = first; i < scene.triangles.size(); ++i) {
        const auto& v = scene.triangles[i].vertices;
        scene.triangles[i].normals = {glm::normalize(v[0]), glm::normalize(v[1]),
                                      glm::normalize(v[2])};
    }
    set_view(scene, {0, 0.5, 5}, {0, 0, 0}, 40);
    return scene;
}

/// A disk of 32 triangles with normals leaning far outwards: mirror rays near its rim would go
/// below.
Scene leaning_mirror() {
    Scene scene = bare_scene();
    const int mirror = add_mirror(scene, 0.75);
    add_floor(scene, {0, -2, 0}, 12, add_matt(scene, {0.875, 0.25, 0.125}));
    const StressMesh fan = fan_mesh(32);
    for (const auto& [a, b, c] : fan.faces) {
        if (a != 0) continue;  // only the upper half, flattened
        const auto flat = [&](int i) {
            const glm::dvec3 p = fan.vertices[static_cast<std::size_t>(i)];
            return glm::dvec3(3 * p.x, 0, 3 * p.z);
        };
        const auto lean = [&](int i) {
            const glm::dvec3 p = flat(i);
            return glm::normalize(glm::dvec3(p.x, 1.25, p.z));
        };
        add_triangle(scene, flat(a), flat(b), flat(c), mirror);
        scene.triangles.back().normals = {lean(a), lean(b), lean(c)};
    }
    add_sphere(scene, {0, 1.5, -4}, 1.5, add_matt(scene, {0.125, 0.25, 0.875}));
    set_view(scene, {0, 1, 7}, {0, 0, 0}, 40);
    return scene;
}

/// One triangle with these normals, parsed like a scene file, which normalizes them.
Scene triangle_with_normals(const char* normals) {
    const std::string text = fmt::format(
        R"({{"camera": {{"from": [0, 0, 4], "at": [0, 0, 0], "fov_degrees": 40}},
"image": {{"width": 80, "height": 60, "aa": "none"}}, "background": [0.25, 0.375, 0.5],
"ambient_light": 0.25, "lights": [{{"position": [2, 3, 4], "intensity": 0.5}}],
"materials": {{"skin": {{"ambient": 0.5, "diffuse": 0.5, "specular": 0.25, "shininess": 20,
"mirror": 0.25, "two_sided": true}}}},
"triangles": [{{"vertices": [[-1, -1, 0], [1, -1, 0.25], [0, 1, -0.25]], "normals": {},
"material": "skin"}}]}})",
        normals);
    return parse_json_scene(text, "normals.json");
}

StressFamily vertex_normals() {
    const auto with = [](const char* normals) {
        return picture_case([=] { return triangle_with_normals(normals); });
    };
    return listed(
        {"vertex-normals", "normals", "normals that cancel, oppose or lack length divide 0 by 0"},
        {{"ordinary", InQuick::no, with("[[-0.3, 0, 1], [0.3, 0, 1], [0, 0.3, 1]]")},
         {"sum-to-zero", InQuick::yes,
          with("[[1, 0, 0], [-0.5, 0.8660254037844386, 0], [-0.5, -0.8660254037844386, 0]]")},
         {"opposing", InQuick::yes, with("[[0, 0, 1], [0, 0, -1], [0, 0, 1]]")},
         {"scaled-1e-3", InQuick::no, with("[[-3e-4, 0, 1e-3], [3e-4, 0, 1e-3], [0, 3e-4, 1e-3]]")},
         {"scaled-1e3", InQuick::no, with("[[-300, 0, 1e3], [300, 0, 1e3], [0, 300, 1e3]]")},
         {"scaled-1e-30-and-1e30", InQuick::yes,
          with("[[-3e-31, 0, 1e-30], [3e29, 0, 1e30], [0, 0.3, 1]]")},
         {"in-the-plane", InQuick::no, with("[[1, 0, 0], [1, 0, 0], [1, 0, 0]]")},
         {"behind", InQuick::no, with("[[0.1, 0, -1], [0, 0.1, -1], [0, 0, -1]]")}});
}

StressFamily smooth_meshes() {
    return listed(
        {"smooth-mesh", "mesh", "mirror rays about blended normals dive under the face they leave"},
        {{"ball", InQuick::no, picture_case([] { return smooth_ball(0); })},
         {"mirror-ball", InQuick::yes, picture_case([] { return smooth_ball(0.5); })},
         {"leaning-mirror", InQuick::yes, picture_case(leaning_mirror)}},
        1);
}

}  // namespace

StressFamilies normal_families() { return {vertex_normals(), smooth_meshes()}; }

}  // namespace rt
