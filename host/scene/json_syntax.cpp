// SPDX-License-Identifier: Apache-2.0
#include "host/scene/json_syntax.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "host/scene/words.h"

namespace rt {
namespace {

constexpr std::string_view blanks = " \t\r\n";
constexpr std::string_view delimiters = " \t\r\n,:[]{}\"/";

bool is_one_of(char c, std::string_view set) { return set.find(c) != std::string_view::npos; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// End offset of the comment at `at`, or `at` if no complete comment starts there.
std::size_t comment_end(std::string_view text, std::size_t at) {
    const std::string_view opening = text.substr(at, 2);
    if (opening == "//") return std::min(text.find_first_of("\r\n", at), text.size());
    if (opening != "/*") return at;
    const std::size_t end = text.find("*/", at + 2);
    return end == std::string_view::npos ? at : end + 2;
}

/// What may appear at the error.
std::string_view expected(JsonState state, bool after_separator) {
    switch (state) {
        case JsonState::start:
            return "'{' to open the scene";
        case JsonState::object_opened:
            return "a key in double quotes or '}'";
        case JsonState::after_key:
            return after_separator ? "a value" : "':' after the key";
        case JsonState::in_object:
            return after_separator ? "a key in double quotes" : "',' or '}'";
        case JsonState::array_opened:
            return "a value or ']'";
        case JsonState::in_array:
            return after_separator ? "a value" : "',' or ']'";
        case JsonState::done:
            return "nothing after the scene's closing bracket";
    }
    return "";
}

bool value_may_follow(JsonState state, bool after_separator) {
    if (state == JsonState::after_key || state == JsonState::in_array) return after_separator;
    return state == JsonState::start || state == JsonState::array_opened;
}

bool key_may_follow(JsonState state, bool after_separator) {
    return state == JsonState::object_opened || (state == JsonState::in_object && after_separator);
}

JsonSyntaxMistake explain_string(std::string_view text, std::size_t at, std::size_t reader_offset) {
    const std::size_t line_end = std::min(text.find_first_of("\r\n", at), text.size());
    if (json_token_end(text, at) > line_end || text[json_token_end(text, at) - 1] != '"' ||
        json_token_end(text, at) == at + 1) {
        return {at, "the string is not closed on the same line; add the closing '\"'"};
    }
    const std::size_t place = std::clamp(reader_offset, at, text.size() - 1);
    if (static_cast<unsigned char>(text[place]) < 0x20) {
        return {place, "the string contains a control character; write it as \\uXXXX"};
    }
    return {place,
            "invalid escape in the string; JSON has \\\" \\\\ \\/ \\b \\f \\n \\r \\t "
            "and \\uXXXX (surrogates in pairs)"};
}

std::string explain_word(std::string_view word) {
    if (word == "NaN" || word == "nan" || nearest_word(word, {{"Infinity"}}) == "Infinity") {
        return fmt::format("{} is not a JSON number; write a finite number", in_quotes(word));
    }
    constexpr std::string_view literals[] = {"true", "false", "null"};
    const std::string_view literal = nearest_word(word, literals);
    if (!literal.empty()) {
        return fmt::format("unknown word {}; did you mean {}?", in_quotes(word), literal);
    }
    return fmt::format("unknown word {}; put text in double quotes", in_quotes(word));
}

/// Explains an error where a value is expected and something else follows.
std::string explain_value(std::string_view text, std::size_t at) {
    const std::string_view word = text.substr(at, json_token_end(text, at) - at);
    if (is_letter(text[at])) return explain_word(word);
    return fmt::format("{} is not a JSON number; write it like 5, -0.5 or 1e-3", in_quotes(word));
}

/// Explains a character that can start no token, whatever was expected; else empty.
std::string explain_character(std::string_view text, std::size_t at) {
    if (text[at] == '\'') return "JSON strings are written in double quotes; replace the ' with \"";
    if (text[at] == '#') return "'#' does not start a comment; use // or /* */";
    if (text[at] != '/') return "";
    if (text.substr(at, 2) == "/*") return "the comment is not closed; add */";
    return "unexpected '/'; comments are // or /* */";
}

std::string explain_end(JsonState state, std::string_view wanted) {
    if (state == JsonState::start) {
        return "the file has no scene; write one such as { \"camera\": ... }";
    }
    return fmt::format("the file ends too early; expected {}", wanted);
}

std::string explain_closing(char bracket) {
    return fmt::format("unexpected comma before '{}'; remove it", bracket);
}

}  // namespace

std::size_t skip_json_blanks(std::string_view text, std::size_t at) {
    while (at < text.size()) {
        if (is_one_of(text[at], blanks)) {
            ++at;
            continue;
        }
        const std::size_t end = comment_end(text, at);
        if (end == at) break;
        at = end;
    }
    return at;
}

std::size_t json_token_end(std::string_view text, std::size_t at) {
    if (at >= text.size()) return text.size();
    if (text[at] != '"') {
        const std::size_t end = text.find_first_of(delimiters, at);
        return std::max(std::min(end, text.size()), at + 1);
    }
    for (std::size_t i = at + 1; i < text.size(); ++i) {
        if (text[i] == '\\') {
            ++i;
        } else if (text[i] == '"') {
            return i + 1;
        }
    }
    return text.size();
}

JsonSyntaxMistake explain_json_syntax(std::string_view text, std::size_t at, JsonState state,
                                      std::size_t reader_offset) {
    if (reader_offset < at) {  // within what looked like one word: 01, 0x10, truefalse
        const std::size_t start = text.find_last_of(delimiters, at - 1) + 1;
        return {start, explain_value(text, start)};
    }
    at = skip_json_blanks(text, at);
    const bool inside = state == JsonState::in_object || state == JsonState::in_array;
    const char separator = inside ? ',' : state == JsonState::after_key ? ':' : '\0';
    const bool separated = at < text.size() && text[at] == separator;
    const std::size_t place = separated ? skip_json_blanks(text, at + 1) : at;
    const std::string_view wanted = expected(state, separated);
    if (place >= text.size()) return {text.size(), explain_end(state, wanted)};
    const char c = text[place];
    const bool value = value_may_follow(state, separated);
    if (std::string message = explain_character(text, place); !message.empty()) {
        return {place, std::move(message)};
    }
    if (c == '"' && (value || key_may_follow(state, separated))) {
        return explain_string(text, place, reader_offset);
    }
    if (separated && inside && (c == '}' || c == ']')) return {at, explain_closing(c)};
    if (value && (is_letter(c) || is_digit(c) || is_one_of(c, "+-."))) {
        return {place, explain_value(text, place)};
    }
    const std::string_view found = text.substr(place, json_token_end(text, place) - place);
    return {place, fmt::format("unexpected {}; expected {}", in_quotes(found), wanted)};
}

}  // namespace rt
