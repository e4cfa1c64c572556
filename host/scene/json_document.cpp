// SPDX-License-Identifier: Apache-2.0
#include "host/scene/json_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <utility>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/scene/words.h"

namespace rt {
namespace {

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
        constexpr std::string_view delimiters = " \t\r\n,:[]{}\"/";
        const std::size_t last = std::min(bytes, text_.size() + 1) - 1;
        const std::size_t start = text_.find_last_of(delimiters, last) + 1;
        const std::size_t offset = std::min(start, last);
        const std::size_t end = text_.find_first_of(delimiters, offset + 1);
        const std::string word = in_quotes(text_.substr(offset, end - offset));
        const std::string_view what = error.what();
        std::string message(what.substr(what.find(" - ") + 3));  // after "syntax error while ..."
        message.erase(std::min(message.find("; last read: "), message.size()));
        if (message == "invalid literal") message = "invalid word " + word;
        const bool is_too_large = error.id == 406;
        fail(offset, is_too_large ? "number " + word + " is too large; write one from -1e30 to 1e30"
                                  : message + "; correct the JSON text");
        return false;
    }

   private:
    /// Bytes that the parser has read, perhaps one beyond the value.
    std::size_t read() const { return static_cast<std::size_t>(next_ - text_.data()); }

    void fail(std::size_t offset, std::string message) {
        mistakes_.add(offset, std::move(message));
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

}  // namespace

JsonValue parse_json(Mistakes& mistakes) {
    const std::string_view text = mistakes.text();
    if (text.size() > max_json_bytes) {
        throw Error(ExitCode::limit, fmt::format("{}: the file is larger than {} MiB; split or "
                                                 "shrink the scene",
                                                 mistakes.place(0), max_json_bytes >> 20));
    }
    if (const auto invalid = find_invalid_utf8(text)) {
        mistakes.add(*invalid, "the file is not UTF-8 text; save it as UTF-8");
        mistakes.throw_if_any();
    }
    return TreeBuilder(mistakes).build();
}

std::string_view kind_of(const JsonValue& value) {
    constexpr std::string_view names[] = {"null",     "true or false", "a number",
                                          "a string", "an array",      "an object"};
    return names[value.data.index()];
}

}  // namespace rt
