// SPDX-License-Identifier: Apache-2.0
#include "host/scene/json_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <system_error>
#include <unordered_map>
#include <utility>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/scene/words.h"

namespace rt {
namespace {

constexpr std::string_view delimiters = " \t\r\n,:[]{}\"/";

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Of the numbers that from_chars accepts, JSON has those that match -?(0|[1-9][0-9]*)(.[0-9]+)?
/// and perhaps an exponent.
bool is_json_number(std::string_view text) {
    const std::string_view whole = text.substr(text.starts_with('-') ? 1 : 0);
    const auto digit_at = [&](std::size_t i) { return i < whole.size() && is_digit(whole[i]); };
    const std::size_t point = whole.find('.');
    return digit_at(0) && !(whole[0] == '0' && digit_at(1)) &&
           (point == whole.npos || digit_at(point + 1));
}

void append_utf8(std::uint32_t code, std::string& text) {
    const auto add = [&](std::uint32_t byte) { text += static_cast<char>(byte); };
    if (code < 0x80) return add(code);
    if (code < 0x800) {
        add(0xC0 | code >> 6);
    } else if (code < 0x10000) {
        add(0xE0 | code >> 12);
        add(0x80 | (code >> 6 & 0x3F));
    } else {
        add(0xF0 | code >> 18);
        add(0x80 | (code >> 12 & 0x3F));
        add(0x80 | (code >> 6 & 0x3F));
    }
    add(0x80 | (code & 0x3F));
}

class Parser {
   public:
    explicit Parser(Mistakes& mistakes) : mistakes_(mistakes), text_(mistakes.text()) {
        if (text_.starts_with(utf8_byte_order_mark)) at_ = utf8_byte_order_mark.size();
    }

    JsonValue read_document() {
        JsonValue root;
        read_value(root, "'{' to open the scene", 0);
        skip_blanks();
        if (at_ != text_.size()) fail_here("nothing after the scene's closing bracket");
        return root;
    }

   private:
    char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }

    /// Throws the mistake, along with those noted before.
    void fail(std::size_t offset, std::string message) {
        mistakes_.add(offset, std::move(message));
        mistakes_.throw_if_any();
    }

    /// Skips blanks and comments.
    void skip_blanks() {
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == ' ' || c == '\n' || c == '\t' || c == '\r') {
                ++at_;
            } else if (c == '/') {
                skip_comment();
            } else {
                return;
            }
        }
    }

    void skip_comment() {
        const std::string_view opening = text_.substr(at_, 2);
        if (opening == "//") {
            at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
        } else if (opening == "/*") {
            const std::size_t end = text_.find("*/", at_ + 2);
            if (end == text_.npos) fail(at_, "the comment is not closed; add */");
            at_ = end + 2;
        } else {
            fail(at_, "unexpected '/'; comments are // or /* */");
        }
    }

    bool take(char c) {
        skip_blanks();
        if (here() != c || at_ == text_.size()) return false;
        ++at_;
        return true;
    }

    /// The number, word or bracket that starts here.
    std::string_view token() const {
        const std::size_t end = std::min(text_.find_first_of(delimiters, at_), text_.size());
        return text_.substr(at_, std::max(end, at_ + 1) - at_);
    }

    /// Says what stands here in place of `wanted`.
    void fail_here(std::string_view wanted) {
        if (at_ >= text_.size()) {
            fail(text_.size(), wanted.starts_with("'{' to")
                                   ? "the file has no scene; write one such as { \"camera\": ... }"
                                   : fmt::format("the file ends too early; expected {}", wanted));
        }
        const std::string_view found =
            here() == '"' ? text_.substr(at_, string_end() - at_) : token();
        fail(at_, fmt::format("unexpected {}; expected {}", in_quotes(found), wanted));
    }

    void read_value(JsonValue& value, std::string_view wanted, std::size_t depth) {
        skip_blanks();
        value.offset = static_cast<std::uint32_t>(at_);
        if (++value_count_ > max_json_values) {
            throw Error(ExitCode::limit, fmt::format("{}: the file has more than {} values; "
                                                     "split or shrink the scene",
                                                     mistakes_.place(at_), max_json_values));
        }
        const char c = here();
        if (c == '{') return read_object(value.data.emplace<JsonValue::Object>(), depth + 1);
        if (c == '[') return read_array(value.data.emplace<JsonValue::Array>(), depth + 1);
        if (c == '"') return read_string(value.data.emplace<std::string>());
        if (is_digit(c) || c == '-' || c == '+' || c == '.') {
            return read_number(value.data.emplace<double>());
        }
        if (!is_letter(c)) fail_here(wanted);
        read_word(value);
    }

    void read_word(JsonValue& value) {
        const std::string_view word = token();
        if (word == "true" || word == "false") {
            value.data = word == "true";
        } else if (word != "null") {
            fail(at_,
                 fmt::format("unknown word {}; write true, false or null, or put text in double "
                             "quotes",
                             in_quotes(word)));
        }
        at_ += word.size();
    }

    void read_number(double& number) {
        const std::string_view word = token();
        const char* const end = word.data() + word.size();
        const auto result = std::from_chars(word.data(), end, number);
        if (!is_json_number(word) || result.ptr != end) {
            fail(at_, fmt::format("{} is not a JSON number; write it like 5, -0.5 or 1e-3",
                                  in_quotes(word)));
        }
        if (result.ec != std::errc()) number = std::strtod(std::string(word).c_str(), nullptr);
        if (!std::isfinite(number)) {
            fail(at_, fmt::format("number {} is too large; write one from -1e30 to 1e30",
                                  in_quotes(word)));
        }
        if (word.find_first_of(".eE") == word.npos) number += 0.0;  // -0 is the whole number 0
        at_ += word.size();
    }

    /// End offset of the string that starts here; the text's end if it is not closed.
    std::size_t string_end() const {
        for (std::size_t i = at_ + 1; i < text_.size(); ++i) {
            if (text_[i] == '"') return i + 1;
            if (text_[i] == '\\') ++i;
        }
        return text_.size();
    }

    void read_string(std::string& string) {
        std::size_t start = at_ + 1, end = start;  // of the part not yet taken over
        while (end < text_.size() && text_[end] != '"') {
            if (static_cast<unsigned char>(text_[end]) < 0x20) fail_string(end, true);
            if (text_[end] != '\\') {
                ++end;
                continue;
            }
            string += text_.substr(start, end - start);
            start = end = read_escape(end + 1, string);
        }
        if (end >= text_.size()) fail_string(end, true);
        string += text_.substr(start, end - start);
        at_ = end + 1;
    }

    void fail_string(std::size_t place, bool is_control) {
        const std::size_t line_end = std::min(text_.find_first_of("\r\n", at_), text_.size());
        const std::size_t end = string_end();
        if (end > line_end || text_[end - 1] != '"' || end == at_ + 1) {
            fail(at_, "the string is not closed on the same line; add the closing '\"'");
        }
        fail(place, is_control
                        ? "the string contains a control character; write it as \\uXXXX"
                        : "invalid escape in the string; JSON has \\\" \\\\ \\/ \\b \\f \\n \\r "
                          "\\t and \\uXXXX (surrogates in pairs)");
    }

    /// Appends what the escape after a backslash means; returns where it ends.
    std::size_t read_escape(std::size_t at, std::string& string) {
        constexpr std::string_view letters = "\"\\/bfnrt", meanings = "\"\\/\b\f\n\r\t";
        const char c = at < text_.size() ? text_[at] : '\0';
        if (const std::size_t known = letters.find(c); known != letters.npos) {
            string += meanings[known];
            return at + 1;
        }
        if (c != 'u') fail_string(at, false);
        std::uint32_t code = read_hex(at + 1);
        at += 5;
        if (code >= 0xD800 && code < 0xE000) {
            const bool paired = code < 0xDC00 && text_.substr(at, 2) == "\\u";
            if (!paired) fail_string(std::min(at, text_.size() - 1), false);
            const std::uint32_t low = read_hex(at + 2);
            if (low < 0xDC00 || low >= 0xE000) fail_string(at + 5, false);
            code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
            at += 6;
        }
        append_utf8(code, string);
        return at;
    }

    std::uint32_t read_hex(std::size_t at) {
        std::uint32_t code = 0;
        const std::string_view digits = text_.substr(std::min(at, text_.size()), 4);
        const auto stop = std::from_chars(digits.begin(), digits.end(), code, 16).ptr;
        const std::size_t end = at + static_cast<std::size_t>(stop - digits.begin());
        if (end != at + 4) fail_string(std::min(end, text_.size() - 1), false);
        return code;
    }

    void open_bracket(std::size_t depth) {
        if (depth > max_json_depth) {
            fail(at_, fmt::format("brackets are nested more than {} deep; flatten the file",
                                  max_json_depth));
        }
        ++at_;
    }

    /// Takes a comma, unless none is there; refuses one before a closing bracket.
    bool take_comma() {
        if (!take(',')) return false;
        const std::size_t comma = at_ - 1;
        skip_blanks();
        if (at_ < text_.size() && (here() == '}' || here() == ']')) {
            fail(comma, fmt::format("unexpected comma before '{}'; remove it", here()));
        }
        return true;
    }

    void read_array(JsonValue::Array& items, std::size_t depth) {
        open_bracket(depth);
        if (take(']')) return;
        do {
            if (items.size() == 1) items.reserve(3);  // vectors and colors, in the main
            const std::string_view wanted = items.empty() ? "a value or ']'" : "a value";
            read_value(items.emplace_back(), wanted, depth);
        } while (take_comma());
        if (!take(']')) fail_here("',' or ']'");
    }

    void read_object(JsonValue::Object& members, std::size_t depth) {
        open_bracket(depth);
        if (take('}')) return;
        do {
            skip_blanks();
            if (here() != '"') {
                fail_here(members.empty() ? "a key in double quotes or '}'"
                                          : "a key in double quotes");
            }
            JsonMember& member = members.emplace_back();
            member.key_offset = static_cast<std::uint32_t>(at_);
            read_string(member.key);
            if (!take(':')) fail_here("':' after the key");
            read_value(member.value, "a value", depth);
        } while (take_comma());
        if (!take('}')) fail_here("',' or '}'");
        note_repeated_keys(members);
    }

    void note_repeated_keys(const JsonValue::Object& members) {
        constexpr std::size_t few = 12;  // where comparing all pairs beats a hash table
        std::unordered_map<std::string_view, const JsonMember*> seen;
        for (auto member = members.begin(); member != members.end(); ++member) {
            const JsonMember* first = nullptr;
            if (members.size() > few) {
                first = seen.emplace(member->key, &*member).first->second;
            } else {
                const auto same = [&](const JsonMember& other) { return other.key == member->key; };
                first = &*std::find_if(members.begin(), member, same);
            }
            if (first == &*member) continue;
            const SourcePosition position = position_of(text_, first->key_offset);
            mistakes_.add(member->key_offset,
                          "key {} is repeated, first at {}:{}; keep one of them",
                          in_quotes(member->key), position.line, position.column);
        }
    }

    Mistakes& mistakes_;
    std::string_view text_;
    std::size_t at_ = 0;
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
    return Parser(mistakes).read_document();
}

std::string_view kind_of(const JsonValue& value) {
    constexpr std::string_view names[] = {"null",     "true or false", "a number",
                                          "a string", "an array",      "an object"};
    return names[value.data.index()];
}

}  // namespace rt
