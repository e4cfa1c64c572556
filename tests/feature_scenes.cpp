// SPDX-License-Identifier: Apache-2.0
#include "tests/feature_scenes.h"

#include "host/scene/aa_mode.h"

namespace rt::test {

namespace {

/// Adds enough of a shape that the scene has to require a hierarchy.
void add_a_row(Scene& scene) {
    for (int i = 0; i < 30; ++i) {
        const glm::dvec3 p(0.1 * i - 1.5, 0.8 - 0.05 * (i % 5), -0.5);
        if (!scene.spheres.empty()) {
            scene.spheres.push_back({p, 0.06, 0});
        } else if (!scene.cones.empty()) {
            scene.cones.push_back({p, p + glm::dvec3(0, 0.1, 0), 0.06, 0.02, 0});
        } else {
            scene.triangles.push_back(
                {{{p, p + glm::dvec3(0.1, 0, 0), p + glm::dvec3(0, 0.1, 0)}}, {}, 0});
        }
    }
}

}  // namespace

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
    if (features[feature::mirrors]) material.mirror = {0.3, 0.4, 0.5};
    if (features[feature::glass]) {
        material.transmission = {0.6, 0.5, 0.4};
        material.ior = 1.4;
    }
    scene.materials.push_back(material);
    if (features[feature::lights])
        scene.lights = {{{2, 3, 4}, {1, 1, 1}}, {{-3, 1, 2}, {0.4, 0.5, 0.6}}};
    if (features[feature::spheres])
        scene.spheres = {{{0, 0.2, 0}, 0.7, 0}, {{0.9, 0, 0.6}, 0.4, 0}};
    if (features[feature::cones]) {
        scene.cones = {{{-0.8, -0.9, 0.8}, {-0.5, 0.6, 0.4}, 0.3, 0.1, 0},
                       {{0.9, 0.5, 0.4}, {0.2, 0.9, 0.2}, 0.2, 0.2, 0}};
    }
    if (features[feature::triangles]) {
        scene.triangles = {{{{{-3, -1, 3}, {3, -1, 3}, {0, -1, -6}}}, {}, 0},
                           {{{{-1, -1, -1}, {-0.2, -1, 0.2}, {-0.8, 1, 0}}}, {}, 0}};
    }
    if (features[feature::huge_spheres]) scene.spheres.push_back({{0, -1e5 - 2, 0}, 1e5, 0});
    if (features[feature::eye_on_surface] && features[feature::spheres]) {
        scene.spheres.push_back({{0, 0.5, 3.015625}, 0.015625, 0});  // too small to be huge
    } else if (features[feature::eye_on_surface] && features[feature::cones]) {
        scene.cones.push_back({{-0.2, 0.5, 3.25}, {0.2, 0.5, 3.25}, 0.25, 0.25, 0});
    } else if (features[feature::eye_on_surface]) {
        scene.triangles.push_back({{{{-2, 0.5, 0}, {2, 0.5, 0}, {0, 0.5, -2}}}, {}, 0});
    }
    if (features[feature::vertex_normals]) {
        scene.triangles[1].normals = {{{-0.6, 0, 0.8}, {0.6, 0, 0.8}, {0, 0.6, 0.8}}};
    }
    if (features[feature::hierarchy]) add_a_row(scene);
    if (features[feature::sobol]) scene.aa = *parse_aa_mode("sobol:4");
    if (features[feature::edges]) scene.aa = *parse_aa_mode("edges:0.05");
    if (features[feature::filters]) scene.filter = Filter::tent;
    return scene;
}

bool is_possible(const Features& features) {
    if (features[feature::vertex_normals] && !features[feature::triangles]) return false;
    if (features[feature::huge_spheres] && !features[feature::spheres]) return false;
    if (features[feature::edges] && (features[feature::filters] || features[feature::sobol]))
        return false;
    const bool any_shape =
        features[feature::spheres] || features[feature::cones] || features[feature::triangles];
    if (features[feature::eye_on_surface] && !any_shape) return false;
    return any_shape || !(features[feature::hierarchy] || features[feature::lights] ||
                          features[feature::mirrors] || features[feature::glass]);
}

}  // namespace rt::test
