// SPDX-License-Identifier: Apache-2.0
#include "host/scene/json_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <utility>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/scene/json_plain.h"
#include "host/scene/json_syntax.h"
#include "host/scene/words.h"

namespace rt {
namespace {

/// Builds a JsonValue tree from nlohmann's SAX events. These carry no positions, but each is one
/// token, so a second scan of the text, one token per event, finds where each starts.
class TreeBuilder {
   public:
    explicit TreeBuilder(Mistakes& mistakes) : mistakes_(mistakes), text_(mistakes.text()) {
        if (text_.starts_with(utf8_byte_order_mark)) end_ = utf8_byte_order_mark.size();
    }

    JsonValue take_root() { return std::move(root_); }

    bool null() { return add_value(std::monostate{}); }
    bool boolean(bool value) { return add_value(value); }
    bool number_integer(std::int64_t value) { return add_value(static_cast<double>(value)); }
    bool number_unsigned(std::uint64_t value) { return add_value(static_cast<double>(value)); }
    bool number_float(double value, const std::string&) { return add_value(value); }
    bool string(std::string& value) { return add_value(std::move(value)); }
    bool binary(nlohmann::json::binary_t&) { return false; }

    bool start_object(std::size_t) { return open(JsonValue::Object{}, JsonState::object_opened); }
    bool start_array(std::size_t) { return open(JsonValue::Array{}, JsonState::array_opened); }
    bool end_array() { return close(); }
    bool end_object() {
        note_repeated_keys(std::get<JsonValue::Object>(open_.back()->data));
        return close();
    }

    bool key(std::string& name) {
        auto& members = std::get<JsonValue::Object>(open_.back()->data);
        members.push_back({std::move(name), next_token(), {}});
        state_ = JsonState::after_key;
        return true;
    }

    template <class Exception>
    bool parse_error(std::size_t characters_read, const std::string&, const Exception& exception) {
        constexpr int number_overflow = 406;
        if (exception.id == number_overflow) {
            const std::size_t start = next_token();
            mistakes_.add(start, fmt::format("number {} is too large; write one from -1e30 to 1e30",
                                             in_quotes(text_.substr(start, end_ - start))));
        } else {
            const std::size_t offset = characters_read > 0 ? characters_read - 1 : 0;
            JsonSyntaxMistake mistake = explain_json_syntax(text_, end_, state_, offset);
            mistakes_.add(mistake.offset, std::move(mistake.message));
        }
        mistakes_.throw_if_any();
        return false;
    }

   private:
    /// Skips the current event's token and returns where it starts.
    std::uint32_t next_token() {
        std::size_t start = skip_json_blanks(text_, end_);
        if (start < text_.size() && (text_[start] == ',' || text_[start] == ':')) {
            start = skip_json_blanks(text_, start + 1);
        }
        end_ = json_token_end(text_, start);
        return static_cast<std::uint32_t>(start);
    }

    template <class T>
    JsonValue& append(T&& data) {
        if (++value_count_ > max_json_values) {
            throw Error(ExitCode::limit, fmt::format("{}: the file has more than {} values; "
                                                     "split or shrink the scene",
                                                     mistakes_.place(end_), max_json_values));
        }
        JsonValue value{std::forward<T>(data), next_token()};
        if (open_.empty()) return root_ = std::move(value);
        if (auto* items = std::get_if<JsonValue::Array>(&open_.back()->data)) {
            return items->emplace_back(std::move(value));
        }
        auto& members = std::get<JsonValue::Object>(open_.back()->data);
        return members.back().value = std::move(value);
    }

    template <class T>
    bool add_value(T&& data) {
        append(std::forward<T>(data));
        settle();
        return true;
    }

    template <class T>
    bool open(T&& data, JsonState state) {
        // Only the innermost container grows, so the pointers to the outer ones stay good.
        open_.push_back(&append(std::forward<T>(data)));
        if (open_.size() > max_json_depth) {
            mistakes_.add(open_.back()->offset,
                          fmt::format("brackets are nested more than {} deep; flatten the file",
                                      max_json_depth));
            mistakes_.throw_if_any();
        }
        state_ = state;
        return true;
    }

    bool close() {
        next_token();
        open_.pop_back();
        settle();
        return true;
    }

    /// A value is complete; its container determines what may follow.
    void settle() {
        if (open_.empty()) {
            state_ = JsonState::done;
        } else {
            state_ =
                open_.back()->as<JsonValue::Array>() ? JsonState::in_array : JsonState::in_object;
        }
    }

    void note_repeated_keys(const JsonValue::Object& members) {
        constexpr std::size_t few = 12;  // where comparing all pairs beats a hash table
        if (members.size() > few) {
            std::unordered_map<std::string_view, const JsonMember*> first;
            for (const JsonMember& member : members) {
                const auto [known, is_new] = first.emplace(member.key, &member);
                if (!is_new) note_repeated(member, *known->second);
            }
            return;
        }
        for (auto member = members.begin(); member != members.end(); ++member) {
            const auto same = [&](const JsonMember& other) { return other.key == member->key; };
            const auto first = std::find_if(members.begin(), member, same);
            if (first != member) note_repeated(*member, *first);
        }
    }

    void note_repeated(const JsonMember& member, const JsonMember& first) {
        const SourcePosition position = position_of(text_, first.key_offset);
        mistakes_.add(member.key_offset,
                      fmt::format("key {} is repeated, first at {}:{}; keep one of them",
                                  in_quotes(member.key), position.line, position.column));
    }

    Mistakes& mistakes_;
    std::string_view text_;
    std::size_t end_ = 0;  ///< just after the last token seen
    std::size_t value_count_ = 0;
    JsonState state_ = JsonState::start;
    JsonValue root_;
    std::vector<JsonValue*> open_;  ///< the containers around the current place
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
    if (auto root = parse_plain_json(text)) return std::move(*root);
    return parse_json_carefully(mistakes);
}

JsonValue parse_json_carefully(Mistakes& mistakes) {
    const std::string_view text = mistakes.text();
    TreeBuilder builder(mistakes);
    constexpr bool strict = true, ignore_comments = true;
    nlohmann::json::sax_parse(text.begin(), text.end(), &builder,
                              nlohmann::json::input_format_t::json, strict, ignore_comments);
    return builder.take_root();
}

std::string_view kind_of(const JsonValue& value) {
    constexpr std::string_view names[] = {"null",     "true or false", "a number",
                                          "a string", "an array",      "an object"};
    return names[value.data.index()];
}

}  // namespace rt
