// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "host/base/text.h"
#include "host/scene/json_document.h"
#include "host/scene/mistakes.h"
#include "host/scene/model.h"
#include "host/scene/scene.h"
#include "host/scene/text_file.h"
#include "host/scene/words.h"

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
/// What one of two words means. `what` is used in messages: "camera type".
template <class T>
std::optional<T> read_choice(const JsonField& field, std::string_view what,
                             const Named<T> (&choices)[2]) {
    const auto text = read_string(field);
    const auto value = text ? value_of(choices, *text) : std::nullopt;
    if (!text || value) return value;
    return field.refuse("unknown {} {}; write \"{}\" or \"{}\"", what, in_quotes(*text),
                        choices[0].name, choices[1].name);
}
std::optional<glm::dvec3> read_vec3(const JsonField& field);
/// [r, g, b] or one number for gray, not negative.
std::optional<glm::dvec3> read_color(const JsonField& field);
const JsonValue::Array* read_array(const JsonField& field,
                                   std::string_view wanted = "an array, [...]");
/// An array of so many items, each read by `read`; notes all that is wrong with them.
template <std::size_t size, class Read>
auto read_items(const JsonField& field, std::string_view wanted_kind, std::string_view wanted_size,
                Read read) {
    std::array<typename std::invoke_result_t<Read, JsonField>::value_type, size> values{};
    std::optional<decltype(values)> nothing;
    const auto* items = read_array(field, wanted_kind);
    if (!items) return nothing;
    if (items->size() != size) {
        field.refuse("{} has {} items; write {}", field.name, items->size(), wanted_size);
        return nothing;
    }
    bool good = true;
    for (std::size_t i = 0; i < size; ++i) {
        const auto value = read(field.item((*items)[i]));
        good = good && value;
        if (value) values[i] = *value;
    }
    return good ? values : nothing;
}

/// An object, whose known keys are those that were asked for. The constructor notes a value that is
/// no object, which then has no members.
class ObjectReader {
   public:
    /// `what` names the object in messages: "a sphere".
    ObjectReader(const JsonValue& value, std::string_view what, Mistakes& mistakes);

    bool is_object() const { return members_ != nullptr; }
    Mistakes& mistakes() const { return field_.mistakes; }
    const JsonValue* find(std::string_view key);
    /// Like find, but notes a missing key. `example` shows what to add.
    const JsonValue* require(std::string_view key, std::string_view example);
    /// Notes the keys that were not asked for.
    void refuse_others() const;

    /// Assigns `read(field)` to `target` if the key exists and its value is valid.
    template <class T, class Read>
    void optional(std::string_view key, T& target, Read read) {
        assign(find(key), key, target, read);
    }

    template <class T, class Read>
    void required(std::string_view key, std::string_view example, T& target, Read read) {
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
    std::array<std::string_view, 16> asked_;  ///< at most: no object has more keys
    std::size_t asked_count_ = 0;
};

/// An item of "meshes" without the model itself, which is loaded only if the scene has no other
/// mistakes.
struct MeshRequest {
    std::string file;             ///< as written in the scene
    std::uint32_t offset = 0;     ///< of the item in the scene's text
    std::optional<int> material;  ///< for all faces, in place of the model's own
    Affine transform;
};

/// Reads a scene's lights, materials and shapes.
std::vector<MeshRequest> read_objects(ObjectReader& reader, const SceneFolder& folder,
                                      Scene& scene);

}  // namespace rt
