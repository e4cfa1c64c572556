// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "host/base/text.h"
#include "host/scene/mistakes.h"
#include "host/scene/words.h"

namespace rt {

struct JsonMember;

/// One value of a JSON text and its offset there (Mistakes converts it to line and column).
/// std::monostate is null.
struct JsonValue {
    using Array = std::vector<JsonValue>;
    using Object = std::vector<JsonMember>;

    std::variant<std::monostate, bool, double, std::string, Array, Object> data;
    std::uint32_t offset = 0;

    template <class T>
    const T* as() const {
        return std::get_if<T>(&data);
    }
};

/// Members keep the order of the file.
struct JsonMember {
    std::string key;
    std::uint32_t key_offset = 0;
    JsonValue value;
};

/// Parses a JSON text (RFC 8259, with // and /* */ comments; skips a byte order mark). Notes
/// repeated keys in `mistakes`; a syntax error is thrown along with earlier mistakes. All numbers
/// are doubles; refuses overflow, and brackets that are nested too deep. Throws Error with
/// ExitCode::limit for too many values.
JsonValue parse_json(Mistakes& mistakes);

/// A value to be read, and what messages call it: its key, or "a sphere".
struct JsonField {
    const JsonValue& value;
    std::string_view name;
    Mistakes& mistakes;

    /// Notes "what is wrong; what to do".
    template <typename... Args>
    std::nullopt_t refuse(fmt::format_string<Args...> message, Args&&... args) const {
        mistakes.add(value.offset, message, std::forward<Args>(args)...);
        return std::nullopt;
    }

    /// Notes that it is of another kind than `wanted`.
    std::nullopt_t refuse_kind(std::string_view wanted) const;

    JsonField item(const JsonValue& of_it) const { return {of_it, name, mistakes}; }
};

// Every read_ function notes why a value is invalid, and then returns nothing.

std::optional<double> read_number(const JsonField& field);
std::optional<double> read_positive(const JsonField& field);
std::optional<double> read_not_negative(const JsonField& field);
/// An angle strictly between 0 and 180 degrees.
std::optional<double> read_angle(const JsonField& field);
std::optional<int> read_integer(const JsonField& field, int low, int high);
std::optional<bool> read_bool(const JsonField& field);
std::optional<std::string> read_string(const JsonField& field);
std::optional<glm::dvec3> read_vec3(const JsonField& field);
/// [r, g, b] or one number for gray, not negative.
std::optional<glm::dvec3> read_color(const JsonField& field);
/// A color, at most max_reflectance.
std::optional<glm::dvec3> read_reflectance(const JsonField& field);
const JsonValue::Array* read_array(const JsonField& field,
                                   std::string_view wanted = "an array, [...]");

/// A reader of whole numbers in a range.
inline auto integer_from(int low, int high) {
    return [=](const JsonField& field) { return read_integer(field, low, high); };
}

/// A reader of one of two words. `what` is used in messages: "camera type".
template <class T>
auto one_of(std::string_view what, const Named<T> (&choices)[2]) {
    return [what, &choices](const JsonField& field) -> std::optional<T> {
        const auto text = read_string(field);
        const auto value = text ? value_of(choices, *text) : std::nullopt;
        if (!text || value) return value;
        return field.refuse("unknown {} {}; write \"{}\" or \"{}\"", what, in_quotes(*text),
                            choices[0].name, choices[1].name);
    };
}

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

/// Asks for the members of an object. Its keys are those that were asked for.
class ObjectReader {
   public:
    const JsonField field;

    explicit ObjectReader(const JsonField& of_object)
        : field(of_object),
          members_(field.value.as<JsonValue::Object>()),
          mistakes_before_(field.mistakes.count()) {}

    /// Null: there is no such key.
    const JsonValue* find(std::string_view key);
    /// Like find, but notes a missing key. `example` shows what to write after it.
    const JsonValue* require(std::string_view key, std::string_view example);

    /// Notes what is wrong with a member, which is there.
    void refuse(std::string_view key, std::string_view message) {
        member(*find(key), key).refuse("{}", message);
    }

    bool is_object() const { return members_ != nullptr; }

    /// Whether nothing was wrong so far.
    bool is_good() const { return field.mistakes.count() == mistakes_before_; }

    /// Assigns `read(field)` to `target` if the key exists and its value is valid. Returns whether
    /// it exists.
    template <class T, class Read>
    bool optional(std::string_view key, T& target, Read read) {
        return assign(find(key), key, target, read);
    }

    template <class T, class Read>
    bool required(std::string_view key, std::string_view example, T& target, Read read) {
        return assign(require(key, example), key, target, read);
    }

    /// read_object of a member, if the key exists. `what` is what messages call it.
    template <class T, class Fields>
    bool object(std::string_view key, std::string_view what, T& target, Fields fields) {
        const JsonValue* value = find(key);
        return value && read_object(member(*value, what), target, fields);
    }

    /// The same for each object of an array, of which it appends one to `target`.
    template <class T, class Fields>
    void list(std::string_view key, std::string_view what, std::vector<T>& target, Fields fields) {
        const JsonValue* value = find(key);
        const auto* items = value ? read_array(member(*value, key)) : nullptr;
        if (!items) return;
        target.reserve(items->size());
        for (const JsonValue& item : *items) {
            read_object(member(item, what), target.emplace_back(), fields);
        }
    }

    /// Notes the keys that were not asked for.
    void refuse_others() const;

   private:
    JsonField member(const JsonValue& value, std::string_view name) const {
        return {value, name, field.mistakes};
    }

    template <class T, class Read>
    bool assign(const JsonValue* value, std::string_view key, T& target, Read read) const {
        if (!value) return false;
        if (auto result = read(member(*value, key))) target = std::move(*result);
        return true;
    }

    const JsonValue::Object* members_;
    std::size_t mistakes_before_;
    std::array<std::string_view, 16> asked_;  ///< at most: no object has more keys
    std::size_t asked_count_ = 0;
};

/// Calls fields(reader, target) for a value that is an object, and notes the keys that it did not
/// ask for. Returns whether nothing was wrong.
template <class T, class Fields>
bool read_object(const JsonField& field, T& target, Fields fields) {
    ObjectReader reader(field);
    if (reader.is_object()) {
        fields(reader, target);
        reader.refuse_others();
    } else {
        field.refuse_kind("an object, {...}");
    }
    return reader.is_good();
}

}  // namespace rt
