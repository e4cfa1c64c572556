// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "host/scene/json_document.h"
#include "host/scene/mistakes.h"
#include "host/scene/model.h"
#include "host/scene/scene.h"
#include "host/scene/text_file.h"

namespace rt {

/// A value to be read, and what messages call it, usually its key.
struct JsonField {
    const JsonValue& value;
    std::string_view name;
    Mistakes& mistakes;

    /// Notes "what is wrong; what to do".
    template <typename... Args>
    std::nullopt_t refuse(fmt::format_string<Args...> message, Args&&... args) const {
        mistakes.add(value.offset, fmt::format(message, std::forward<Args>(args)...));
        return std::nullopt;
    }

    JsonField item(const JsonValue& of_it) const { return {of_it, name, mistakes}; }
};

// Every read_ function notes why a value is invalid, and then returns nothing.

std::optional<double> read_number(const JsonField& field);
std::optional<double> read_positive(const JsonField& field);
std::optional<int> read_integer(const JsonField& field, int low, int high);
std::optional<std::string> read_string(const JsonField& field);
/// An angle strictly between 0 and 180 degrees.
std::optional<double> read_angle(const JsonField& field);
/// True for the first of two words. `what` is used in messages: "camera type".
std::optional<bool> read_choice(const JsonField& field, std::string_view what,
                                std::string_view first, std::string_view second);
std::optional<glm::dvec3> read_vec3(const JsonField& field);
/// [r, g, b] or one number for gray, not negative.
std::optional<glm::dvec3> read_color(const JsonField& field);
/// An array; if `size` >= 0, of exactly that many items.
const JsonValue::Array* read_array(const JsonField& field, int size = -1);

/// An object with a fixed set of keys. The constructor notes unknown keys, and a value that is no
/// object, which then has no members.
class ObjectReader {
   public:
    /// `what` names the object in messages: "a sphere".
    ObjectReader(const JsonValue& value, std::string_view what,
                 std::span<const std::string_view> known_keys, Mistakes& mistakes);

    bool is_object() const { return members_ != nullptr; }
    Mistakes& mistakes() const { return field_.mistakes; }
    const JsonMember* find_member(std::string_view key) const;
    const JsonValue* find(std::string_view key) const;
    /// Like find, but notes a missing key. `example` shows what to add.
    const JsonValue* require(std::string_view key, std::string_view example) const;

    /// Assigns `read(field)` to `target` if the key exists and its value is valid.
    template <class T, class Read>
    void optional(std::string_view key, T& target, Read read) const {
        assign(find(key), key, target, read);
    }

    template <class T, class Read>
    void required(std::string_view key, std::string_view example, T& target, Read read) const {
        assign(require(key, example), key, target, read);
    }

   private:
    template <class T, class Read>
    void assign(const JsonValue* value, std::string_view key, T& target, Read read) const {
        if (!value) return;
        if (auto result = read(JsonField{*value, key, mistakes()})) target = std::move(*result);
    }

    const JsonValue::Object* members_;
    JsonField field_;
};

/// The materials of a scene file, looked up by name.
class MaterialTable {
   public:
    /// Reads the "materials" object (null: the file has none).
    MaterialTable(const JsonValue* value, Mistakes& mistakes);

    /// The index of the material a shape names; notes an unknown one.
    std::optional<int> read_reference(const JsonField& field) const;

    std::vector<Scene::Material> take() { return std::move(materials_); }

   private:
    std::vector<Scene::Material> materials_;
    std::unordered_map<std::string, int> index_;
    bool readable_ = true;  ///< false: names are unknown, so all are accepted
};

Scene::Light read_light(const JsonField& item);
Scene::Sphere read_sphere(const JsonField& item, const MaterialTable& materials);
Scene::Cone read_cone(const JsonField& item, const MaterialTable& materials);
Scene::Triangle read_triangle(const JsonField& item, const MaterialTable& materials);

/// An item of "meshes" without the model itself, which is loaded only if the scene has no other
/// mistakes.
struct MeshRequest {
    std::string file;             ///< as written in the scene
    std::uint32_t offset = 0;     ///< of the item in the scene's text
    std::optional<int> material;  ///< for all faces, in place of the model's own
    Affine transform;
};

MeshRequest read_mesh(const JsonField& item, const MaterialTable& materials,
                      const SceneFolder& folder);

/// Loads the models and appends their materials to the scene's. Throws as load_model does.
void load_meshes(const std::vector<MeshRequest>& requests, const SceneFolder& folder, Scene& scene,
                 Mistakes& mistakes);

}  // namespace rt
