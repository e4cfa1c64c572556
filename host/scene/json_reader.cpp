// SPDX-License-Identifier: Apache-2.0
#include "host/scene/json_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/scene/scene_limits.h"
#include "host/scene/words.h"

namespace rt {
namespace {

void note_kind(const JsonValue& value, std::string_view name, std::string_view wanted,
               Mistakes& mistakes) {
    mistakes.add(value.offset, fmt::format("{} is {}; write {}", name, kind_of(value), wanted));
}

void note_number(const JsonValue& value, std::string_view name, double number,
                 std::string_view wanted, Mistakes& mistakes) {
    mistakes.add(value.offset, fmt::format("{} is {}; write {}", name, number, wanted));
}

/// The three items of a vector or color; notes anything else.
const JsonValue::Array* read_triple(const JsonValue& value, std::string_view name,
                                    std::string_view wanted, Mistakes& mistakes) {
    const auto* items = value.as<JsonValue::Array>();
    if (!items) {
        note_kind(value, name, wanted, mistakes);
    } else if (items->size() != 3) {
        mistakes.add(value.offset,
                     fmt::format("{} has {} items; write {}", name, items->size(), wanted));
        return nullptr;
    }
    return items;
}

/// The three items, each read by read_one(item, name, mistakes).
template <typename Read>
std::optional<glm::dvec3> read_items(const JsonValue::Array* items, std::string_view name,
                                     Mistakes& mistakes, Read read_one) {
    if (!items) return std::nullopt;
    glm::dvec3 result{0};
    bool good = true;
    for (int i = 0; i < 3; ++i) {
        const auto number = read_one((*items)[static_cast<std::size_t>(i)], name, mistakes);
        good = good && number;
        if (number) result[i] = *number;
    }
    return good ? std::optional(result) : std::nullopt;
}

glm::dvec3 gray(double level) { return glm::dvec3(level, level, level); }

/// What other programs call a key, where no known key is spelled much like it.
constexpr std::pair<std::string_view, std::string_view> synonyms[] = {
    {"pos", "position"},
    {"pos", "from"},
    {"pos", "center"},
    {"position", "from"},
    {"position", "center"},
    {"position", "translate"},
    {"location", "position"},
    {"location", "from"},
    {"origin", "from"},
    {"eye", "from"},
    {"look_at", "at"},
    {"lookat", "at"},
    {"target", "at"},
    {"color", "diffuse"},
    {"color", "intensity"},
    {"colour", "diffuse"},
    {"colour", "intensity"},
    {"reflection", "mirror"},
    {"reflectivity", "mirror"},
    {"refraction", "ior"},
    {"opacity", "transmission"},
    {"exponent", "shininess"},
    {"power", "intensity"},
    {"brightness", "intensity"},
    {"samples", "aa"},
    {"antialiasing", "aa"},
    {"size", "width"},
    {"resolution", "width"},
    {"points", "vertices"},
    {"path", "file"},
    {"rotation", "rotate_degrees"},
    {"depth", "max_bounces"}};

std::string guess(std::string_view key, std::span<const std::string_view> known) {
    for (const auto& [word, meant] : synonyms) {
        const bool fits = word == key && std::ranges::find(known, meant) != known.end();
        if (fits) return fmt::format("did you mean {}?", in_quotes(meant));
    }
    return suggestion(key, known, "known keys are");
}

}  // namespace

std::optional<double> read_number(const JsonValue& value, std::string_view name,
                                  Mistakes& mistakes) {
    const double* number = value.as<double>();
    if (!number) {
        note_kind(value, name, "a number", mistakes);
    } else if (!(std::abs(*number) <= max_scene_number)) {
        note_number(value, name, *number, "a number from -1e30 to 1e30", mistakes);
    } else {
        return *number;
    }
    return std::nullopt;
}

std::optional<double> read_positive(const JsonValue& value, std::string_view name,
                                    Mistakes& mistakes) {
    const auto number = read_number(value, name, mistakes);
    if (!number || *number > 0) return number;
    note_number(value, name, *number, "a number above 0", mistakes);
    return std::nullopt;
}

std::optional<double> read_not_negative(const JsonValue& value, std::string_view name,
                                        Mistakes& mistakes) {
    const auto number = read_number(value, name, mistakes);
    if (!number || *number >= 0) return number;
    note_number(value, name, *number, "0 or more", mistakes);
    return std::nullopt;
}

std::optional<int> read_integer(const JsonValue& value, std::string_view name, int low, int high,
                                Mistakes& mistakes) {
    const std::string wanted = fmt::format("a whole number from {} to {}", low, high);
    const double* number = value.as<double>();
    if (!number) {
        note_kind(value, name, wanted, mistakes);
    } else if (!(*number >= low && *number <= high) || *number != std::floor(*number)) {
        note_number(value, name, *number, wanted, mistakes);
    } else {
        return static_cast<int>(*number);
    }
    return std::nullopt;
}

std::optional<bool> read_bool(const JsonValue& value, std::string_view name, Mistakes& mistakes) {
    if (const bool* truth = value.as<bool>()) return *truth;
    note_kind(value, name, "true or false", mistakes);
    return std::nullopt;
}

const std::string* read_string(const JsonValue& value, std::string_view name, Mistakes& mistakes) {
    const auto* text = value.as<std::string>();
    if (!text) note_kind(value, name, "text in double quotes", mistakes);
    return text;
}

std::optional<double> read_angle(const JsonValue& value, std::string_view name,
                                 Mistakes& mistakes) {
    const auto degrees = read_positive(value, name, mistakes);
    if (!degrees || *degrees < 180) return degrees;
    mistakes.add(value.offset,
                 fmt::format("{} is {}; write an angle between 0 and 180", name, *degrees));
    return std::nullopt;
}

std::optional<bool> read_choice(const JsonValue& value, std::string_view name,
                                std::string_view what, std::string_view first,
                                std::string_view second, Mistakes& mistakes) {
    const std::string* text = read_string(value, name, mistakes);
    if (!text) return std::nullopt;
    if (*text == first || *text == second) return *text == first;
    mistakes.add(value.offset, fmt::format("unknown {} {}; write \"{}\" or \"{}\"", what,
                                           in_quotes(*text), first, second));
    return std::nullopt;
}

std::optional<glm::dvec3> read_vec3(const JsonValue& value, std::string_view name,
                                    Mistakes& mistakes) {
    const auto* items = read_triple(value, name, "three numbers, [x, y, z]", mistakes);
    return read_items(items, name, mistakes, read_number);
}

std::optional<glm::dvec3> read_color(const JsonValue& value, std::string_view name,
                                     Mistakes& mistakes) {
    if (value.as<double>()) {
        const auto level = read_not_negative(value, name, mistakes);
        return level ? std::optional(gray(*level)) : std::nullopt;
    }
    constexpr std::string_view wanted = "one number for a gray, or three, [r, g, b]";
    const auto* items = read_triple(value, name, wanted, mistakes);
    return read_items(items, name, mistakes, read_not_negative);
}

std::optional<glm::dvec3> read_reflectance(const JsonValue& value, std::string_view name,
                                           Mistakes& mistakes) {
    const auto color = read_color(value, name, mistakes);
    if (!color) return std::nullopt;
    const double largest = std::max({color->r, color->g, color->b});
    if (largest <= max_reflectance) return color;
    note_number(value, name, largest, fmt::format("{} at most", max_reflectance), mistakes);
    return std::nullopt;
}

const JsonValue::Array* read_array(const JsonValue& value, std::string_view name, int size,
                                   Mistakes& mistakes) {
    const auto* items = value.as<JsonValue::Array>();
    if (!items) {
        note_kind(value, name, "an array, [...]", mistakes);
    } else if (size >= 0 && items->size() != static_cast<std::size_t>(size)) {
        mistakes.add(value.offset,
                     fmt::format("{} has {} items; write {} of them", name, items->size(), size));
        return nullptr;
    }
    return items;
}

ObjectReader::ObjectReader(const JsonValue& value, std::string_view what,
                           std::span<const std::string_view> known_keys, Mistakes& mistakes)
    : members_(value.as<JsonValue::Object>()),
      offset_(value.offset),
      what_(what),
      mistakes_(mistakes) {
    if (!members_) {
        note_kind(value, what, "an object, {...}", mistakes);
        return;
    }
    for (const JsonMember& member : *members_) {
        if (std::ranges::find(known_keys, member.key) != known_keys.end()) continue;
        mistakes.add(member.key_offset,
                     fmt::format("unknown key {} in {}; {}", in_quotes(member.key), what,
                                 guess(member.key, known_keys)));
    }
}

const JsonMember* ObjectReader::find_member(std::string_view key) const {
    if (!members_) return nullptr;
    const auto found = std::ranges::find(*members_, key, &JsonMember::key);
    return found == members_->end() ? nullptr : &*found;
}

const JsonValue* ObjectReader::find(std::string_view key) const {
    const JsonMember* member = find_member(key);
    return member ? &member->value : nullptr;
}

const JsonValue* ObjectReader::require(std::string_view key, std::string_view example) const {
    const JsonValue* value = find(key);
    if (!value && members_) {
        mistakes_.add(offset_, fmt::format("{} has no {}; add {}", what_, in_quotes(key), example));
    }
    return value;
}

}  // namespace rt
