// SPDX-License-Identifier: Apache-2.0
#include "host/scene/json_path.h"

#include <fmt/format.h>

#include <optional>

#include "host/scene/geometry_checks.h"
#include "host/scene/json_reader.h"
#include "host/scene/words.h"

namespace rt {

namespace {

using Fixed = Scene::FieldOfView::Fixed;

constexpr std::string_view path_keys[] = {"interpolation", "keys"};
constexpr std::string_view key_keys[] = {"frame",       "from",   "at",   "up",
                                         "fov_degrees", "height", "width"};

std::optional<bool> read_is_smooth(const JsonValue& value, std::string_view name,
                                   Mistakes& mistakes) {
    return read_choice(value, name, name, "catmull-rom", "linear", mistakes);
}

/// The key for the field of view of this kind of camera; "" if it has a window.
std::string_view extent_key(const Scene::Camera& camera) {
    switch (camera.field_of_view.fixed) {
        case Fixed::horizontal:
        case Fixed::vertical:
            return "fov_degrees";
        case Fixed::view_width:
            return "width";
        case Fixed::view_height:
            return "height";
        case Fixed::window:
            return "";
    }
    return "";
}

void read_extent(const ObjectReader& reader, Scene::Camera& camera, Mistakes& mistakes) {
    const std::string_view own = extent_key(camera);
    for (const std::string_view key : {"fov_degrees", "width", "height"}) {
        const JsonMember* member = reader.find_member(key);
        if (member == nullptr || key == own) continue;
        mistakes.add(
            member->key_offset,
            fmt::format("{} is not allowed here: the scene's camera gives {}", in_quotes(key),
                        own.empty() ? "a window" : in_quotes(std::string(own))));
    }
    if (own == "fov_degrees") {
        reader.optional(own, camera.field_of_view.amount, read_angle);
    } else if (!own.empty()) {
        reader.optional(own, camera.field_of_view.amount, read_positive);
    }
}

Scene::CameraPath::Key read_key(const JsonValue& value, const Scene::Camera& camera,
                                Mistakes& mistakes) {
    Scene::CameraPath::Key key{0, camera};
    const ObjectReader reader(value, "a key of the path", key_keys, mistakes);
    if (!reader.is_object()) return key;
    const std::size_t before = mistakes.count();
    reader.required("frame", "\"frame\": 1", key.frame, read_number);
    reader.optional("from", key.camera.from, read_vec3);
    reader.optional("at", key.camera.at, read_vec3);
    reader.optional("up", key.camera.up, read_vec3);
    read_extent(reader, key.camera, mistakes);
    if (mistakes.count() != before) return key;
    if (const auto mistake = find_axes_mistake(key.camera.from, key.camera.at, key.camera.up)) {
        mistakes.add(value.offset, mistake->message);
    }
    return key;
}

}  // namespace

Scene::CameraPath read_camera_path(const JsonValue& value, const Scene::Camera& camera,
                                   Mistakes& mistakes) {
    Scene::CameraPath path;
    const ObjectReader reader(value, "the path", path_keys, mistakes);
    if (!reader.is_object()) return path;
    reader.optional("interpolation", path.is_smooth, read_is_smooth);
    const JsonValue* keys =
        reader.require("keys", "\"keys\": [{\"frame\": 1, \"from\": [0, 0, 5]}]");
    const auto* items = keys ? read_array(*keys, "keys", -1, mistakes) : nullptr;
    if (!items) return path;
    if (items->empty()) mistakes.add(keys->offset, "the path has no keys; give one or more");
    for (const JsonValue& item : *items) {
        const std::size_t before = mistakes.count();
        const Scene::CameraPath::Key key = read_key(item, camera, mistakes);
        if (mistakes.count() != before) continue;
        if (!path.keys.empty() && key.frame <= path.keys.back().frame) {
            mistakes.add(item.offset,
                         fmt::format("frame {} comes after frame {}; put the keys in order",
                                     key.frame, path.keys.back().frame));
            continue;
        }
        path.keys.push_back(key);
    }
    return path;
}

}  // namespace rt
