// SPDX-License-Identifier: Apache-2.0
#include "host/scene/model.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/scene/mesh.h"
#include "host/scene/mtl_file.h"

namespace rt {
namespace {

/// The name of a file in a folder that differs only in letter case; else the name itself.
std::string in_any_case(const std::filesystem::path& folder, const std::string& name) {
    std::error_code error;
    const std::filesystem::path path = folder / name;
    if (exists(path, error)) return name;
    const std::filesystem::path parent = path.has_parent_path() ? path.parent_path() : ".";
    for (const auto& entry : std::filesystem::directory_iterator(parent, error)) {
        const std::string found = entry.path().filename().string();
        if (lower(found) != lower(path.filename().string())) continue;
        return (std::filesystem::path(name).parent_path() / found).string();
    }
    return name;
}

/// Opens libraries in the model's folder or beneath it.
OpenLibrary library_opener(const std::string& model_path, const std::filesystem::path& root) {
    const SceneFolder folder{root, std::filesystem::path(model_path).parent_path()};
    return [folder](const std::string& name) {
        OpenedFile opened = open_beneath(folder, name);
        if (!opened.problem.empty()) {
            const std::string problem = opened.problem;
            const std::string other = in_any_case(folder.base, name);
            if (other != name) opened = open_beneath(folder, other);
            if (!opened.problem.empty()) return LibraryFile{{}, {}, problem};
        }
        const FileText text = read_text_file(opened.file, opened.path, max_model_bytes);
        return LibraryFile{opened.path, std::string(text.view()), {}};
    };
}

Model parse_model(const FileDescriptor& file, const std::string& path,
                  const ModelOptions& options) {
    const FileText text = read_text_file(file, path, max_model_bytes);
    refuse_foreign(path, text.view());
    if (is_ply_name(path)) return parse_ply(text.view(), printable(path));
    OpenLibrary open;
    if (options.with_materials) open = library_opener(path, options.root);
    return parse_obj(text.view(), printable(path), open);
}

constexpr double fov_degrees = 40;

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

bool is_obj_name(const std::string& path) { return lower_extension(path) == ".obj"; }
bool is_ply_name(const std::string& path) { return lower_extension(path) == ".ply"; }

Model load_model(const FileDescriptor& file, const std::string& path, const ModelOptions& options) {
    Model model = parse_model(file, path, options);
    finish_mesh(model.mesh, options.transform, printable(path), model.notes);
    return model;
}

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
