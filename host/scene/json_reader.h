// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "host/scene/json_document.h"
#include "host/scene/mistakes.h"

namespace rt {

// Every read_ function notes in `mistakes` why a value is invalid, and then returns nothing. `name`
// is what messages call the value, usually its key.

std::optional<double> read_number(const JsonValue& value, std::string_view name,
                                  Mistakes& mistakes);
std::optional<double> read_positive(const JsonValue& value, std::string_view name,
                                    Mistakes& mistakes);
std::optional<double> read_not_negative(const JsonValue& value, std::string_view name,
                                        Mistakes& mistakes);
std::optional<int> read_integer(const JsonValue& value, std::string_view name, int low, int high,
                                Mistakes& mistakes);
std::optional<bool> read_bool(const JsonValue& value, std::string_view name, Mistakes& mistakes);
const std::string* read_string(const JsonValue& value, std::string_view name, Mistakes& mistakes);
/// An angle strictly between 0 and 180 degrees.
std::optional<double> read_angle(const JsonValue& value, std::string_view name, Mistakes& mistakes);
/// True for the first of two words. `what` is used in messages: "camera type".
std::optional<bool> read_choice(const JsonValue& value, std::string_view name,
                                std::string_view what, std::string_view first,
                                std::string_view second, Mistakes& mistakes);
std::optional<glm::dvec3> read_vec3(const JsonValue& value, std::string_view name,
                                    Mistakes& mistakes);
/// [r, g, b] or one number for gray, not negative.
std::optional<glm::dvec3> read_color(const JsonValue& value, std::string_view name,
                                     Mistakes& mistakes);
/// The same, at most max_reflectance.
std::optional<glm::dvec3> read_reflectance(const JsonValue& value, std::string_view name,
                                           Mistakes& mistakes);
/// An array; if `size` >= 0, of exactly that many items.
const JsonValue::Array* read_array(const JsonValue& value, std::string_view name, int size,
                                   Mistakes& mistakes);

/// An object with a fixed set of keys. The constructor notes unknown keys, and a value that is no
/// object, which then has no members.
class ObjectReader {
   public:
    /// `what` names the object in messages: "a sphere".
    ObjectReader(const JsonValue& value, std::string_view what,
                 std::span<const std::string_view> known_keys, Mistakes& mistakes);

    bool is_object() const { return members_ != nullptr; }
    const JsonMember* find_member(std::string_view key) const;
    const JsonValue* find(std::string_view key) const;
    /// Like find, but notes a missing key. `example` shows what to add.
    const JsonValue* require(std::string_view key, std::string_view example) const;

    /// Assigns `read(value, key, mistakes)` to `target` if the key exists and its value is valid.
    template <class T, class Read>
    void optional(std::string_view key, T& target, Read read) const {
        if (const JsonValue* value = find(key)) {
            if (const auto result = read(*value, key, mistakes_)) target = *result;
        }
    }

    template <class T, class Read>
    void required(std::string_view key, std::string_view example, T& target, Read read) const {
        if (const JsonValue* value = require(key, example)) {
            if (const auto result = read(*value, key, mistakes_)) target = *result;
        }
    }

   private:
    const JsonValue::Object* members_ = nullptr;
    std::uint32_t offset_ = 0;
    std::string_view what_;
    Mistakes& mistakes_;
};

}  // namespace rt
