// SPDX-License-Identifier: Apache-2.0

#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>

#include "host/base/text.h"
#include "host/scene/geometry.h"
#include "host/scene/json_objects.h"
#include "host/scene/scene.h"
#include "host/scene/scene_file.h"
#include "host/scene/words.h"

namespace rt {
namespace {

using Fixed = Scene::FieldOfView::Fixed;

constexpr int max_max_bounces = 100000;

std::optional<AaMode> read_aa(const JsonField& field) {
    const auto text = read_string(field);
    if (!text) return std::nullopt;
    const auto mode = parse_aa_mode(*text);
    if (!mode) field.refuse("unknown aa {}; write {}", in_quotes(*text), aa_mode_help);
    return mode;
}

std::optional<int> read_side(const JsonField& field) {
    return read_integer(field, 1, max_image_side);
}

void read_image(const JsonValue& value, Scene& scene, Mistakes& mistakes) {
    ObjectReader reader(value, "the image", mistakes);
    reader.optional("width", scene.width, read_side);
    reader.optional("height", scene.height, read_side);
    reader.optional("aa", scene.aa, read_aa);
    reader.refuse_others();
    const auto pixels = static_cast<std::int64_t>(scene.width) * scene.height;
    if (pixels <= max_image_pixels) return;
    mistakes.add(value.offset, "the image has {} pixels; make it {} at most", pixels,
                 max_image_pixels);
}

constexpr Named<Scene::Projection> projections[] = {
    {"perspective", Scene::Projection::perspective},
    {"orthographic", Scene::Projection::orthographic}};
constexpr Named<Fixed> fov_axes[] = {{"x", Fixed::horizontal}, {"y", Fixed::vertical}};
constexpr Named<bool> interpolations[] = {{"catmull-rom", true}, {"linear", false}};

std::optional<Scene::Window> read_window(const JsonField& field) {
    const auto sides = read_items<4>(field, "an array, [...]", "4 of them", read_number);
    if (!sides) return std::nullopt;
    const auto [left, right, bottom, top] = *sides;
    if (left < right && bottom < top) return Scene::Window{left, right, bottom, top};
    return field.refuse(
        "the window is empty or mirrored; write [left, right, bottom, top] with left < right and "
        "bottom < top");
}

/// The one of the keys that is present; notes it if there is none, or more.
std::optional<std::string_view> find_only(ObjectReader& camera, const JsonValue& value,
                                          std::span<const std::string_view> wanted) {
    std::optional<std::string_view> only;
    int count = 0;
    for (const std::string_view key : wanted) {
        if (!camera.find(key)) continue;
        only = key;
        ++count;
    }
    if (count == 1) return only;
    camera.mistakes().add(value.offset, "the camera gives {} of {}; give exactly one", count,
                          word_list(wanted));
    return std::nullopt;
}

void read_perspective(ObjectReader& reader, const JsonValue& value, Scene::Camera& camera) {
    const auto key = find_only(reader, value, {{"fov_degrees", "window"}});
    if (key == "window") return;
    camera.field_of_view.fixed = Fixed::vertical;
    reader.optional("fov_axis", camera.field_of_view.fixed, [](const JsonField& field) {
        return read_choice(field, field.name, fov_axes);
    });
    if (key) reader.optional("fov_degrees", camera.field_of_view.amount, read_angle);
}

void read_orthographic(ObjectReader& reader, const JsonValue& value, Scene::Camera& camera) {
    const auto key = find_only(reader, value, {{"height", "width", "window"}});
    if (!key || key == "window") return;
    camera.field_of_view.fixed = key == "height" ? Fixed::view_height : Fixed::view_width;
    reader.optional(*key, camera.field_of_view.amount, read_positive);
}

/// Reads the "camera" object; camera_window computes the window unless the file gives one.
Scene::Camera read_camera(const JsonValue& value, Mistakes& mistakes) {
    Scene::Camera camera;
    ObjectReader reader(value, "the camera", mistakes);
    if (!reader.is_object()) return camera;
    const std::size_t before = mistakes.count();
    reader.required("from", "\"from\": [x, y, z], where the eye is", camera.from, read_vec3);
    reader.required("at", "\"at\": [x, y, z], where it looks", camera.at, read_vec3);
    reader.optional("up", camera.up, read_vec3);
    if (mistakes.count() == before) {
        if (const auto mistake = find_axes_mistake(camera.from, camera.at, camera.up)) {
            const JsonValue* up = mistake->is_up ? reader.find("up") : nullptr;
            mistakes.add((up ? up : reader.find("at"))->offset, mistake->message);
        }
    }
    reader.optional("window", camera.window, read_window);
    const std::size_t before_type = mistakes.count();
    reader.optional("type", camera.projection, [](const JsonField& field) {
        return read_choice(field, "camera type", projections);
    });
    if (mistakes.count() != before_type) return camera;  // the valid keys are unknown
    if (camera.projection == Scene::Projection::perspective) {
        read_perspective(reader, value, camera);
    } else {
        read_orthographic(reader, value, camera);
    }
    reader.refuse_others();
    return camera;
}

/// The keys for what a camera fixes of its field of view, unless it has a window.
constexpr Named<Fixed> extents[] = {{"fov_degrees", Fixed::horizontal},
                                    {"fov_degrees", Fixed::vertical},
                                    {"width", Fixed::view_width},
                                    {"height", Fixed::view_height}};

Scene::CameraPath::Key read_key(const JsonField& item, const Scene::Camera& camera) {
    Scene::CameraPath::Key key{0, camera};
    ObjectReader reader(item.value, "a key of the path", item.mistakes);
    const std::size_t before = item.mistakes.count();
    reader.required("frame", "\"frame\": 1", key.frame, read_number);
    reader.optional("from", key.camera.from, read_vec3);
    reader.optional("at", key.camera.at, read_vec3);
    reader.optional("up", key.camera.up, read_vec3);
    const std::string_view extent = name_of(extents, camera.field_of_view.fixed);
    if (!extent.empty()) {
        reader.optional(extent, key.camera.field_of_view.amount,
                        extent == "fov_degrees" ? read_angle : read_positive);
    }
    reader.refuse_others();
    if (item.mistakes.count() != before) return key;
    if (const auto mistake = find_axes_mistake(key.camera.from, key.camera.at, key.camera.up)) {
        item.refuse("{}", mistake->message);
    }
    return key;
}

/// Once around `at` and back to the start in so many frames, the first of which is 1.
std::vector<Scene::CameraPath::Key> turntable(const Scene::Camera& camera, int frames) {
    const glm::dvec3 axis = unit_direction(camera.up).value_or(glm::dvec3(0, 1, 0));
    std::vector<Scene::CameraPath::Key> keys;
    for (int i = 0; i < frames; ++i) {
        keys.push_back({i + 1.0, camera});
        keys.back().camera.from =
            camera.at + turned(camera.from - camera.at, axis, 360.0 * i / frames);
    }
    return keys;
}

/// Reads "path". Keys inherit what they omit from `camera`, the scene's own.
Scene::CameraPath read_camera_path(const JsonValue& value, const Scene::Camera& camera,
                                   Mistakes& mistakes) {
    Scene::CameraPath path;
    ObjectReader reader(value, "the path", mistakes);
    reader.optional("interpolation", path.is_smooth, [](const JsonField& field) {
        return read_choice(field, field.name, interpolations);
    });
    int frames = 0;
    reader.optional("turntable", frames,
                    [](const JsonField& field) { return read_integer(field, 2, 100000); });
    const JsonValue* whole = reader.find("turntable");
    const JsonValue* keys = reader.find("keys");
    reader.refuse_others();
    if (whole) {
        if (keys)
            mistakes.add(whole->offset, "a path has either 'turntable' or 'keys'; remove one");
        path.keys = turntable(camera, frames);
        return path;
    }
    keys = reader.require("keys", "\"keys\": [{\"frame\": 1, \"from\": [0, 0, 5]}]");
    const auto* items = keys ? read_array({*keys, "keys", mistakes}) : nullptr;
    if (!items) return path;
    if (items->empty()) mistakes.add(keys->offset, "the path has no keys; give one or more");
    for (const JsonValue& value_of_key : *items) {
        const JsonField item{value_of_key, "keys", mistakes};
        const std::size_t before = mistakes.count();
        const Scene::CameraPath::Key key = read_key(item, camera);
        if (mistakes.count() != before) continue;
        if (!path.keys.empty() && key.frame <= path.keys.back().frame) {
            item.refuse("frame {} comes after frame {}; put the keys in order", key.frame,
                        path.keys.back().frame);
            continue;
        }
        path.keys.push_back(key);
    }
    return path;
}

std::optional<std::string> read_name(const JsonField& field) {
    const auto name = read_string(field);
    if (!name || printable(*name) == *name) return name;
    return field.refuse("'name' contains a control character; use plain text");
}

/// Reads all but the objects.
void read_settings(ObjectReader& reader, Scene& scene) {
    Mistakes& mistakes = reader.mistakes();
    std::string ignored;  // for editors and people
    reader.optional("$schema", ignored, read_string);
    reader.optional("description", ignored, read_string);
    reader.optional("name", scene.name, read_name);
    constexpr std::string_view example =
        "\"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0], \"fov_degrees\": 60}";
    const JsonValue* camera = reader.require("camera", example);
    const JsonValue* path = reader.find("path");
    if (camera) {
        const std::size_t before = mistakes.count();
        scene.camera = read_camera(*camera, mistakes);
        if (path && mistakes.count() == before) {
            scene.path = read_camera_path(*path, scene.camera, mistakes);
        }
    }
    if (const JsonValue* image = reader.find("image")) read_image(*image, scene, mistakes);
    reader.optional("max_bounces", scene.max_bounces,
                    [](const JsonField& field) { return read_integer(field, 0, max_max_bounces); });
    reader.optional("background", scene.background, read_color);
    reader.optional("ambient_light", scene.ambient_light, read_color);
}

/// Appends a model and its materials to the scene.
void add_model(Model model, const MeshRequest& request, Scene& scene) {
    const auto first = static_cast<int>(scene.materials.size());
    std::vector<int>& materials = model.mesh.face_materials;
    if (request.material) materials = {*request.material};
    if (!request.material) {
        for (int& material : materials) material += first;
        std::ranges::move(model.materials, std::back_inserter(scene.materials));
    }
    scene.meshes.push_back(std::move(model.mesh));
    std::ranges::move(model.notes, std::back_inserter(scene.notes));
    std::ranges::move(model.library_files, std::back_inserter(scene.model_files));
}

/// Loads the models and appends their materials to the scene's. Throws as load_model does.
void load_meshes(const std::vector<MeshRequest>& requests, const SceneFolder& folder, Scene& scene,
                 Mistakes& mistakes) {
    for (const MeshRequest& request : requests) {
        const OpenedFile opened = open_beneath(folder, request.file);
        if (!opened.problem.empty()) {
            mistakes.add(request.offset, opened.problem);
            continue;
        }
        const ModelOptions options{folder.root, !request.material, request.transform};
        Model model = load_model(opened.file, opened.path, options);
        if (!request.material && model.materials.empty()) {
            mistakes.add(request.offset,
                         "a mesh has no \"material\", and {} has none "
                         "either; add \"material\": \"name\"",
                         in_quotes(opened.path));
            continue;
        }
        add_model(std::move(model), request, scene);
        scene.model_files.push_back(opened.path);
    }
}

}  // namespace

Scene parse_json_scene(std::string_view text, const std::string& file_name) {
    Mistakes mistakes(text, file_name);
    const JsonValue root = parse_json(mistakes);
    const SceneFolder folder = SceneFolder::of(file_name);
    ObjectReader reader(root, "the scene", mistakes);
    Scene scene;
    read_settings(reader, scene);
    const std::vector<MeshRequest> meshes = read_objects(reader, folder, scene);
    reader.refuse_others();
    mistakes.throw_if_any();
    load_meshes(meshes, folder, scene, mistakes);
    mistakes.throw_if_any();
    if (scene.name.empty()) scene.name = name_of_file(file_name);
    set_image_size(scene, scene.width, scene.height);
    return scene;
}

}  // namespace rt
