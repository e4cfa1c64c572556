// SPDX-License-Identifier: Apache-2.0
#include "host/scene/json_fields.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "host/scene/geometry.h"
#include "host/scene/scene.h"

namespace rt {
namespace {

std::nullopt_t refuse_number(const JsonField& field, double number, std::string_view wanted) {
    return field.refuse("{} is {}; write {}", field.name, number, wanted);
}

/// Three items, each read by `read`.
template <typename Read>
std::optional<glm::dvec3> read_triple(const JsonField& field, std::string_view wanted, Read read) {
    const auto items = read_items<3>(field, wanted, wanted, read);
    if (!items) return std::nullopt;
    const auto [x, y, z] = *items;
    return glm::dvec3(x, y, z);
}

}  // namespace

std::optional<double> read_number(const JsonField& field) {
    const double* number = field.value.as<double>();
    if (!number) return field.refuse_kind("a number");
    if (std::abs(*number) <= max_scene_number) return *number;
    return refuse_number(field, *number, "a number from -1e30 to 1e30");
}

std::optional<double> read_positive(const JsonField& field) {
    const auto number = read_number(field);
    if (!number || *number > 0) return number;
    return refuse_number(field, *number, "a number above 0");
}

std::optional<double> read_not_negative(const JsonField& field) {
    const auto number = read_number(field);
    if (!number || *number >= 0) return number;
    return refuse_number(field, *number, "0 or more");
}

std::optional<double> read_angle(const JsonField& field) {
    const auto degrees = read_positive(field);
    if (!degrees || *degrees < 180) return degrees;
    return refuse_number(field, *degrees, "an angle between 0 and 180");
}

std::optional<int> read_integer(const JsonField& field, int low, int high) {
    const std::string wanted = fmt::format("a whole number from {} to {}", low, high);
    const double* number = field.value.as<double>();
    if (!number) return field.refuse_kind(wanted);
    if (*number >= low && *number <= high && *number == std::floor(*number)) {
        return static_cast<int>(*number);
    }
    return refuse_number(field, *number, wanted);
}

std::optional<bool> read_bool(const JsonField& field) {
    if (const bool* truth = field.value.as<bool>()) return *truth;
    return field.refuse_kind("true or false");
}

std::optional<std::string> read_string(const JsonField& field) {
    if (const auto* text = field.value.as<std::string>()) return *text;
    return field.refuse_kind("text in double quotes");
}

std::optional<glm::dvec3> read_vec3(const JsonField& field) {
    return read_triple(field, "three numbers, [x, y, z]", read_number);
}

std::optional<glm::dvec3> read_color(const JsonField& field) {
    if (field.value.as<double>()) {
        const auto level = read_not_negative(field);
        return level ? std::optional(glm::dvec3(*level)) : std::nullopt;
    }
    return read_triple(field, "one number for a gray, or three, [r, g, b]", read_not_negative);
}

std::optional<glm::dvec3> read_reflectance(const JsonField& field) {
    const auto color = read_color(field);
    if (!color || largest(*color) <= max_reflectance) return color;
    return refuse_number(field, largest(*color), fmt::format("{} at most", max_reflectance));
}

const JsonValue::Array* read_array(const JsonField& field, std::string_view wanted) {
    const auto* items = field.value.as<JsonValue::Array>();
    if (!items) field.refuse_kind(wanted);
    return items;
}

const JsonValue* ObjectReader::find(std::string_view key) {
    const auto asked = std::span(asked_).first(asked_count_);
    if (std::ranges::find(asked, key) == asked.end()) asked_.at(asked_count_++) = key;
    const auto found = std::ranges::find(*members_, key, &JsonMember::key);
    return found == members_->end() ? nullptr : &found->value;
}

const JsonValue* ObjectReader::require(std::string_view key, std::string_view example) {
    const JsonValue* value = find(key);
    if (!value) {
        field.refuse("{} has no {}; add \"{}\": {}", field.name, in_quotes(key), key, example);
    }
    return value;
}

void ObjectReader::refuse_others() const {
    const auto asked = std::span(asked_).first(asked_count_);
    for (const JsonMember& member : *members_) {
        if (std::ranges::find(asked, member.key) != asked.end()) continue;
        field.mistakes.add(member.key_offset, "unknown key {} in {}; {}", in_quotes(member.key),
                           field.name, suggestion(member.key, asked, "known keys are"));
    }
}

}  // namespace rt
