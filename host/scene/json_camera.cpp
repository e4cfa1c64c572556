// SPDX-License-Identifier: Apache-2.0
#include "host/scene/json_camera.h"

#include <fmt/format.h>

#include <initializer_list>
#include <optional>
#include <string_view>

#include "host/scene/geometry_checks.h"
#include "host/scene/json_reader.h"
#include "host/scene/words.h"

namespace rt {
namespace {

using Fixed = Scene::FieldOfView::Fixed;

constexpr std::string_view camera_keys[] = {"type",     "from",   "at",     "up",   "fov_degrees",
                                            "fov_axis", "window", "height", "width"};

std::optional<Scene::Projection> read_projection(const JsonValue& value, std::string_view name,
                                                 Mistakes& mistakes) {
    using Projection = Scene::Projection;
    const auto is_perspective =
        read_choice(value, name, "camera type", "perspective", "orthographic", mistakes);
    if (!is_perspective) return std::nullopt;
    return *is_perspective ? Projection::perspective : Projection::orthographic;
}

std::optional<Fixed> read_fov_axis(const JsonValue& value, std::string_view name,
                                   Mistakes& mistakes) {
    const auto is_x = read_choice(value, name, name, "x", "y", mistakes);
    if (!is_x) return std::nullopt;
    return *is_x ? Fixed::horizontal : Fixed::vertical;
}

std::optional<Scene::Window> read_window(const JsonValue& value, std::string_view name,
                                         Mistakes& mistakes) {
    const auto* items = read_array(value, name, 4, mistakes);
    if (!items) return std::nullopt;
    double sides[4] = {};
    for (int i = 0; i < 4; ++i) {
        const auto number = read_number((*items)[i], name, mistakes);
        if (!number) return std::nullopt;
        sides[i] = *number;
    }
    const auto [left, right, bottom, top] = sides;
    if (left < right && bottom < top) return Scene::Window{left, right, bottom, top};
    mistakes.add(value.offset,
                 "the window is empty or mirrored; write [left, right, bottom, top] with left < "
                 "right and bottom < top");
    return std::nullopt;
}

/// Notes every key that does not apply to this kind of camera.
void refuse_keys(const ObjectReader& camera, std::initializer_list<std::string_view> unwanted,
                 std::string_view where, std::string_view advice, Mistakes& mistakes) {
    for (const std::string_view key : unwanted) {
        if (const JsonMember* member = camera.find_member(key)) {
            mistakes.add(member->key_offset,
                         fmt::format("{} is not allowed in {}; {}", in_quotes(key), where, advice));
        }
    }
}

/// Whether exactly one of the keys is present; notes it otherwise.
bool has_exactly_one(const ObjectReader& camera, const JsonValue& value,
                     std::initializer_list<std::string_view> wanted, std::string_view names,
                     Mistakes& mistakes) {
    int count = 0;
    for (const std::string_view key : wanted) count += camera.find(key) != nullptr;
    if (count == 1) return true;
    mistakes.add(value.offset,
                 fmt::format("the camera gives {} of {}; give exactly one", count, names));
    return false;
}

void read_perspective(const ObjectReader& reader, const JsonValue& value, Scene::Camera& camera,
                      Mistakes& mistakes) {
    refuse_keys(reader, {"width", "height"}, "a perspective camera",
                "use fov_degrees or window, or \"type\": \"orthographic\"", mistakes);
    if (!has_exactly_one(reader, value, {"fov_degrees", "window"}, "'fov_degrees' and 'window'",
                         mistakes)) {
        return;
    }
    if (!reader.find("fov_degrees")) {
        refuse_keys(reader, {"fov_axis"}, "a camera with a window", "remove it or use fov_degrees",
                    mistakes);
        return;
    }
    camera.field_of_view.fixed = Fixed::vertical;
    reader.optional("fov_axis", camera.field_of_view.fixed, read_fov_axis);
    reader.optional("fov_degrees", camera.field_of_view.amount, read_angle);
}

void read_orthographic(const ObjectReader& reader, const JsonValue& value, Scene::Camera& camera,
                       Mistakes& mistakes) {
    refuse_keys(reader, {"fov_degrees", "fov_axis"}, "an orthographic camera",
                "use height, width or window, or \"type\": \"perspective\"", mistakes);
    if (!has_exactly_one(reader, value, {"height", "width", "window"},
                         "'height', 'width' and 'window'", mistakes)) {
        return;
    }
    if (reader.find("height")) camera.field_of_view.fixed = Fixed::view_height;
    if (reader.find("width")) camera.field_of_view.fixed = Fixed::view_width;
    reader.optional("height", camera.field_of_view.amount, read_positive);
    reader.optional("width", camera.field_of_view.amount, read_positive);
}

/// Notes when from, at and up do not span a camera frame.
void check_axes(const ObjectReader& reader, const Scene::Camera& camera, Mistakes& mistakes) {
    const auto place = [&](std::string_view key) {
        return (reader.find(key) ? reader.find(key) : reader.find("at"))->offset;
    };
    if (const auto mistake = find_axes_mistake(camera.from, camera.at, camera.up)) {
        mistakes.add(place(mistake->is_up ? "up" : "at"), mistake->message);
    }
}

}  // namespace

Scene::Camera read_camera(const JsonValue& value, Mistakes& mistakes) {
    Scene::Camera camera;
    const ObjectReader reader(value, "the camera", camera_keys, mistakes);
    if (!reader.is_object()) return camera;
    const std::size_t before = mistakes.count();
    reader.required("from", "\"from\": [x, y, z], where the eye is", camera.from, read_vec3);
    reader.required("at", "\"at\": [x, y, z], where it looks", camera.at, read_vec3);
    reader.optional("up", camera.up, read_vec3);
    if (mistakes.count() == before) check_axes(reader, camera, mistakes);
    reader.optional("window", camera.window, read_window);
    const std::size_t before_type = mistakes.count();
    reader.optional("type", camera.projection, read_projection);
    if (mistakes.count() != before_type) return camera;  // the valid keys are unknown
    if (camera.projection == Scene::Projection::perspective) {
        read_perspective(reader, value, camera, mistakes);
    } else {
        read_orthographic(reader, value, camera, mistakes);
    }
    return camera;
}

}  // namespace rt
