// SPDX-License-Identifier: Apache-2.0
#include "host/scene/json_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "host/base/printable.h"
#include "host/scene/json_camera.h"
#include "host/scene/json_document.h"
#include "host/scene/json_meshes.h"
#include "host/scene/json_path.h"
#include "host/scene/json_reader.h"
#include "host/scene/json_shapes.h"
#include "host/scene/scene_limits.h"
#include "host/scene/scene_name.h"
#include "host/scene/text_file.h"
#include "host/scene/words.h"

namespace rt {
namespace {

constexpr int max_max_bounces = 100000;

constexpr std::string_view scene_keys[] = {
    "$schema",     "description", "name",          "camera", "image",
    "max_bounces", "background",  "ambient_light", "lights", "materials",
    "spheres",     "cones",       "triangles",     "meshes", "path"};
constexpr std::string_view image_keys[] = {"width", "height", "aa"};

std::optional<AaMode> read_aa(const JsonValue& value, std::string_view name, Mistakes& mistakes) {
    const std::string* text = read_string(value, name, mistakes);
    if (!text) return std::nullopt;
    const auto mode = parse_aa_mode(*text);
    if (!mode) {
        mistakes.add(value.offset,
                     fmt::format("unknown aa {}; write {}", in_quotes(*text), aa_mode_help));
    }
    return mode;
}

std::optional<int> read_side(const JsonValue& value, std::string_view name, Mistakes& mistakes) {
    return read_integer(value, name, 1, max_image_side, mistakes);
}

std::optional<int> read_bounces(const JsonValue& value, std::string_view name, Mistakes& mistakes) {
    return read_integer(value, name, 0, max_max_bounces, mistakes);
}

void read_image(const JsonValue& value, Scene& scene, Mistakes& mistakes) {
    const ObjectReader reader(value, "the image", image_keys, mistakes);
    reader.optional("width", scene.width, read_side);
    reader.optional("height", scene.height, read_side);
    reader.optional("aa", scene.aa, read_aa);
    const auto pixels = static_cast<std::int64_t>(scene.width) * scene.height;
    if (pixels <= max_image_pixels) return;
    mistakes.add(value.offset, fmt::format("the image has {} pixels; make it {} at most", pixels,
                                           max_image_pixels));
}

/// Appends read(item) for every item of the array under `key`, if it is there.
template <class T, class Read>
void read_list(const ObjectReader& reader, std::string_view key, std::vector<T>& target,
               Mistakes& mistakes, Read read) {
    const JsonValue* value = reader.find(key);
    const auto* items = value ? read_array(*value, key, -1, mistakes) : nullptr;
    if (!items) return;
    target.reserve(items->size());
    for (const JsonValue& item : *items) target.push_back(read(item));
}

/// A scene without its meshes, which are loaded only if all else is valid.
struct SceneText {
    Scene scene;
    std::vector<MeshRequest> meshes;
};

void read_objects(const ObjectReader& reader, const SceneFolder& folder, SceneText& text,
                  Mistakes& mistakes) {
    Scene& scene = text.scene;
    MaterialTable materials(reader.find("materials"), mistakes);
    read_list(reader, "lights", scene.lights, mistakes,
              [&](const JsonValue& item) { return read_light(item, mistakes); });
    read_list(reader, "spheres", scene.spheres, mistakes,
              [&](const JsonValue& item) { return read_sphere(item, materials, mistakes); });
    read_list(reader, "cones", scene.cones, mistakes,
              [&](const JsonValue& item) { return read_cone(item, materials, mistakes); });
    read_list(reader, "triangles", scene.triangles, mistakes,
              [&](const JsonValue& item) { return read_triangle(item, materials, mistakes); });
    read_list(reader, "meshes", text.meshes, mistakes,
              [&](const JsonValue& item) { return read_mesh(item, materials, folder, mistakes); });
    scene.materials = materials.take();
}

void read_name(const ObjectReader& reader, Scene& scene, Mistakes& mistakes) {
    for (const std::string_view key : {"$schema", "description"}) {  // for editors and people
        if (const JsonValue* text = reader.find(key)) read_string(*text, key, mistakes);
    }
    if (const JsonValue* value = reader.find("name")) {
        const std::string* name = read_string(*value, "name", mistakes);
        if (name && printable(*name) != *name) {
            mistakes.add(value->offset, "'name' contains a control character; use plain text");
        } else if (name) {
            scene.name = *name;
        }
    }
}

SceneText read_scene(const JsonValue& root, const SceneFolder& folder, Mistakes& mistakes) {
    SceneText text;
    Scene& scene = text.scene;
    const ObjectReader reader(root, "the scene", scene_keys, mistakes);
    if (!reader.is_object()) return text;
    read_name(reader, scene, mistakes);
    constexpr std::string_view example =
        "\"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0], \"fov_degrees\": 60}";
    if (const JsonValue* camera = reader.require("camera", example)) {
        const std::size_t before = mistakes.count();
        scene.camera = read_camera(*camera, mistakes);
        const JsonValue* path = reader.find("path");
        if (path && mistakes.count() == before) {
            scene.path = read_camera_path(*path, scene.camera, mistakes);
        }
    }
    if (const JsonValue* image = reader.find("image")) read_image(*image, scene, mistakes);
    reader.optional("max_bounces", scene.max_bounces, read_bounces);
    reader.optional("background", scene.background, read_color);
    reader.optional("ambient_light", scene.ambient_light, read_color);
    read_objects(reader, folder, text, mistakes);
    return text;
}

}  // namespace

Scene load_json_scene(const std::string& path) {
    const FileText text = read_text_file(path, max_json_bytes);
    refuse_foreign(path, text.view());
    return parse_json_scene(text.view(), path);
}

Scene parse_json_scene(std::string_view text, const std::string& file_name) {
    Mistakes mistakes(text, file_name);
    const JsonValue root = parse_json(mistakes);
    const SceneFolder folder = SceneFolder::of(file_name);
    SceneText read = read_scene(root, folder, mistakes);
    mistakes.throw_if_any();
    Scene& scene = read.scene;
    load_meshes(read.meshes, folder, scene, mistakes);
    mistakes.throw_if_any();
    if (scene.name.empty()) scene.name = name_of_file(file_name);
    set_image_size(scene, scene.width, scene.height);
    return std::move(scene);
}

}  // namespace rt
