// SPDX-License-Identifier: Apache-2.0
#include "host/scene/json_document.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <unordered_map>

#include "host/base/error.h"
#include "host/scene/geometry.h"
#include "host/scene/scene.h"

namespace rt {
namespace {

constexpr std::size_t max_json_values = std::size_t{1} << 25;
constexpr std::size_t max_json_depth = 64;

constexpr const char* not_utf8 = "the file is not UTF-8 text; save it as UTF-8";

/// A character of the text, for the parser, which says nowhere how far it has read.
struct Cursor {
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    const char* at;
    const char** furthest;  ///< behind the last character read

    reference operator*() const { return *at; }
    Cursor& operator++() {
        *furthest = ++at;
        return *this;
    }
    bool operator!=(const Cursor& other) const { return at != other.at; }
};

/// What nlohmann's parser calls (its SAX interface); makes a tree with the places of its values.
class TreeBuilder {
   public:
    explicit TreeBuilder(Mistakes& mistakes) : mistakes_(mistakes), text_(mistakes.text()) {}

    JsonValue build() {
        const char* const end = text_.data() + text_.size();
        nlohmann::json::sax_parse(Cursor{text_.data(), &next_}, Cursor{end, &next_}, this,
                                  nlohmann::json::input_format_t::json, true, true);
        return std::move(root_);
    }

    bool null() { return add(std::monostate(), read() - 4); }
    bool boolean(bool value) { return add(value, read() - (value ? 4 : 5)); }
    bool number_integer(std::int64_t value) { return number(static_cast<double>(value)); }
    bool number_unsigned(std::uint64_t value) { return number(static_cast<double>(value)); }
    bool number_float(double value, const std::string& /*text*/) { return number(value); }
    bool string(std::string& value) { return add(std::move(value), start_of_string()); }
    bool binary(nlohmann::json::binary_t& /*value*/) { return false; }  // not in JSON

    bool start_object(std::size_t /*size*/) { return open(JsonValue::Object()); }
    bool key(std::string& value) {
        auto& members = std::get<JsonValue::Object>(open_.back()->data);
        members.push_back({std::move(value), start_of_string(), {}});
        return true;
    }
    bool end_object() {
        note_repeated_keys(*open_.back()->as<JsonValue::Object>());
        open_.pop_back();
        return true;
    }

    bool start_array(std::size_t /*size*/) { return open(JsonValue::Array()); }
    bool end_array() {
        open_.pop_back();
        return true;
    }

    /// Throws the mistake, along with those noted before. `bytes`: read so far.
    bool parse_error(std::size_t bytes, const std::string& /*token*/,
                     const nlohmann::json::exception& error) {
        const std::string_view what = error.what();
        std::string message(what.substr(what.find(" - ") + 3));  // after "syntax error while ..."
        message.erase(std::min(message.find("; last read: "), message.size()));
        const bool is_word = message == "invalid literal";  // perhaps up to what was read last
        constexpr std::string_view delimiters = " \t\r\n,:[]{}\"/";
        const std::size_t last = std::min(bytes, text_.size() + 1) - 1;
        const std::size_t start =
            text_.find_last_of(delimiters, is_word && last > 0 ? last - 1 : last) + 1;
        const std::size_t offset = std::min(start, last);
        const std::size_t end = text_.find_first_of(delimiters, offset + 1);
        const std::string word = in_quotes(text_.substr(offset, end - offset));
        if (is_word) message = "invalid word " + word;
        const bool is_too_large = error.id == 406;
        const bool is_utf8 = !message.ends_with("ill-formed UTF-8 byte");
        fail(offset, is_too_large ? "number " + word + " is too large; write one from -1e30 to 1e30"
                     : is_utf8    ? message + "; correct the JSON text"
                                  : not_utf8);
        return false;
    }

   private:
    /// Bytes that the parser has read, perhaps one beyond the value.
    std::size_t read() const { return static_cast<std::size_t>(next_ - text_.data()); }

    void fail(std::size_t offset, std::string message) {
        mistakes_.add(offset, "{}", message);
        mistakes_.throw_if_any();
    }

    /// Adds a value to the innermost open array or object.
    bool add(decltype(JsonValue::data) data, std::size_t offset) {
        if (++value_count_ > max_json_values) {
            throw Error(ExitCode::limit, fmt::format("{}: the file has more than {} values; "
                                                     "split or shrink the scene",
                                                     mistakes_.place(offset), max_json_values));
        }
        JsonValue& value = place();
        value.data = std::move(data);
        value.offset = static_cast<std::uint32_t>(offset);
        last_ = &value;
        return true;
    }

    JsonValue& place() {
        if (open_.empty()) return root_;
        auto* const items = std::get_if<JsonValue::Array>(&open_.back()->data);
        if (!items) return std::get<JsonValue::Object>(open_.back()->data).back().value;
        if (items->size() == 1) items->reserve(3);  // vectors and colors, in the main
        return items->emplace_back();
    }

    bool open(decltype(JsonValue::data) empty) {
        const std::size_t offset = read() - 1;
        if (open_.size() == max_json_depth) {
            fail(offset, fmt::format("brackets are nested more than {} deep; flatten the file",
                                     max_json_depth));
        }
        add(std::move(empty), offset);
        open_.push_back(last_);
        return true;
    }

    /// The parser has read the number, and perhaps what follows it.
    bool number(double value) {
        const std::size_t last = text_.find_last_of("0123456789", read() - 1);
        return add(value, text_.find_last_not_of("0123456789+-.eE", last) + 1);
    }

    /// Of the one whose closing quote was read last.
    std::uint32_t start_of_string() const {
        std::size_t quote = read() - 1;
        for (bool is_escaped = true; is_escaped;) {
            quote = text_.rfind('"', quote - 1);
            const std::size_t before = text_.substr(0, quote).find_last_not_of('\\');
            is_escaped = (quote - before) % 2 == 0;
        }
        return static_cast<std::uint32_t>(quote);
    }

    void note_repeated_keys(const JsonValue::Object& members) {
        std::unordered_map<std::string_view, const JsonMember*> seen;
        for (const JsonMember& member : members) {
            const JsonMember* const first = seen.emplace(member.key, &member).first->second;
            if (first == &member) continue;
            mistakes_.add(member.key_offset, "key {} is repeated, first at {}; keep one of them",
                          in_quotes(member.key), position_of(text_, first->key_offset));
        }
    }

    Mistakes& mistakes_;
    const std::string_view text_;
    const char* next_ = text_.data();
    JsonValue root_;
    JsonValue* last_ = nullptr;     ///< the value added last
    std::vector<JsonValue*> open_;  ///< arrays and objects, the innermost last
    std::size_t value_count_ = 0;
};

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

JsonValue parse_json(Mistakes& mistakes) {
    const std::string_view text = mistakes.text();
    if (const std::size_t nul = text.find('\0'); nul != text.npos) {  // ends the parser's text
        mistakes.add(nul, "{}", not_utf8);
        mistakes.throw_if_any();
    }
    return TreeBuilder(mistakes).build();
}

std::nullopt_t JsonField::refuse_kind(std::string_view wanted) const {
    constexpr std::string_view kinds[] = {"null",     "true or false", "a number",
                                          "a string", "an array",      "an object"};
    return refuse("{} is {}; write {}", name, kinds[value.data.index()], wanted);
}

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
