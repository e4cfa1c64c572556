// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "host/base/error.h"
#include "host/base/parallel.h"
#include "host/base/printable.h"
#include "host/scene/geometry_checks.h"
#include "host/scene/model_file.h"
#include "host/scene/mtl_file.h"
#include "host/scene/scene_name.h"
#include "host/scene/text_file.h"

namespace rt {
namespace {

constexpr double fov_degrees = 40;

struct BoundingSphere {
    glm::dvec3 center{0};
    double radius = 0;
};

struct Box {
    glm::dvec3 low{0}, high{0};
};

/// Calls work(value, position) for the corners of all faces, in parallel. Each run of faces has its
/// own value, initially `start`; returns these values.
template <typename Value, typename Work>
std::vector<Value> over_corners(const Scene::Mesh& mesh, const Value& start, Work work) {
    constexpr std::size_t grain = 1 << 15;
    std::vector<Value> values((mesh.faces.size() + grain - 1) / grain, start);
    for_each_run(mesh.faces.size(), grain, available_cores(),
                 [&](std::size_t first, std::size_t last) {
                     Value value = start;
                     for (std::size_t f = first; f < last; ++f) {
                         for (const std::uint32_t i : mesh.faces[f]) work(value, mesh.positions[i]);
                     }
                     values[first / grain] = value;
                 });
    return values;
}

/// Centered on the bounding box of all faces. Unused vertices do not count.
BoundingSphere bounding_sphere(const Scene::Mesh& mesh) {
    const glm::dvec3 first = mesh.positions[mesh.faces[0][0]];
    Box all{first, first};
    const auto boxes = over_corners(mesh, all, [](Box& box, const glm::dvec3& p) {
        box = {glm::min(box.low, p), glm::max(box.high, p)};
    });
    for (const Box& box : boxes) all = {glm::min(all.low, box.low), glm::max(all.high, box.high)};
    BoundingSphere sphere{0.5 * all.low + 0.5 * all.high, 0};
    const auto radii = over_corners(mesh, 0.0, [&](double& radius, const glm::dvec3& p) {
        radius = std::max(radius, glm::length(p - sphere.center));
    });
    sphere.radius = std::ranges::max(radii);
    return sphere;
}

/// Fits the sphere to all sides of a square picture.
Scene::Camera framing_camera(const BoundingSphere& sphere) {
    constexpr double half_angle = fov_degrees * (std::numbers::pi / 360.0);
    const glm::dvec3 towards = glm::normalize(glm::dvec3(0.6, 0.45, 1));
    Scene::Camera camera;
    camera.at = sphere.center;
    camera.from = sphere.center + sphere.radius / std::sin(half_angle) * towards;
    camera.field_of_view = {Scene::FieldOfView::Fixed::vertical, fov_degrees};
    return camera;
}

/// The key light is high on the camera's left, a weak fill light on its right.
std::vector<Scene::Light> default_lights(const BoundingSphere& sphere) {
    const glm::dvec3 key = 4.0 * sphere.radius * glm::dvec3(-0.5, 1, 1);
    const glm::dvec3 fill = 4.0 * sphere.radius * glm::dvec3(1, 0.4, 0.5);
    return {{sphere.center + key, glm::dvec3(0.75), false},
            {sphere.center + fill, glm::dvec3(0.25), false}};
}

}  // namespace

Scene make_model_scene(Model model, const std::string& path) {
    const BoundingSphere sphere = bounding_sphere(model.mesh);
    Scene scene;
    scene.name = name_of_file(path);
    scene.camera = framing_camera(sphere);
    if (nearly_same_point(scene.camera.from, scene.camera.at)) {
        throw Error(
            ExitCode::input,
            printable(path) +
                ": the model is too small for its distance from the origin; move it closer");
    }
    scene.background = glm::dvec3(0.85, 0.9, 0.95);
    scene.ambient_light = glm::dvec3(0.25);
    scene.lights = default_lights(sphere);
    scene.materials = std::move(model.materials);
    if (scene.materials.empty()) {
        scene.materials.push_back(default_material());
        model.mesh.face_materials = {0};
    }
    scene.meshes.push_back(std::move(model.mesh));
    scene.notes = std::move(model.notes);
    scene.model_files = std::move(model.library_files);
    set_image_size(scene, scene.width, scene.height);
    return scene;
}

Scene load_model_scene(const std::string& path) {
    ModelOptions options;
    options.root = SceneFolder::of(path).root;
    return make_model_scene(load_model(open_text_file(path), path, options), path);
}

}  // namespace rt
