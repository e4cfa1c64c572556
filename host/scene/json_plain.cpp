// SPDX-License-Identifier: Apache-2.0
#include "host/scene/json_plain.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <system_error>
#include <utility>

#include "host/base/text.h"
#include "host/scene/json_syntax.h"

namespace rt {
namespace {

class PlainReader {
   public:
    explicit PlainReader(std::string_view text) : text_(text) {
        if (text_.starts_with(utf8_byte_order_mark)) at_ = utf8_byte_order_mark.size();
    }

    std::optional<JsonValue> read() {
        JsonValue root;
        if (!read_value(root, 0)) return std::nullopt;
        skip_blanks();
        if (at_ != text_.size()) return std::nullopt;
        return root;
    }

   private:
    char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }

    void skip_blanks() {
        const char c = here();
        if (c != ' ' && c != '\n' && c != '\r' && c != '\t' && c != '/') return;
        at_ = skip_json_blanks(text_, at_);
    }

    bool take(char c) {
        skip_blanks();
        if (here() != c) return false;
        ++at_;
        return true;
    }

    bool read_value(JsonValue& value, std::size_t depth) {
        skip_blanks();
        value.offset = static_cast<std::uint32_t>(at_);
        if (++values_ > max_json_values) return false;
        switch (here()) {
            case '{':
                return read_object(value.data.emplace<JsonValue::Object>(), depth + 1);
            case '[':
                return read_array(value.data.emplace<JsonValue::Array>(), depth + 1);
            case '"':
                return read_string(value.data.emplace<std::string>());
            case 't':
                value.data = true;
                return read_word("true");
            case 'f':
                value.data = false;
                return read_word("false");
            case 'n':
                return read_word("null");
            default:
                return read_number(value.data.emplace<double>());
        }
    }

    bool read_word(std::string_view word) {
        if (text_.substr(at_, word.size()) != word) return false;
        at_ += word.size();
        return json_token_end(text_, at_ - word.size()) == at_;
    }

    /// -?(0|[1-9][0-9]*)(.[0-9]+)?([eE][+-]?[0-9]+)?, to its end.
    bool is_json_number(std::string_view number) const {
        std::size_t i = number.starts_with('-') ? 1 : 0;
        const auto digits = [&] {
            const std::size_t start = i;
            while (i < number.size() && number[i] >= '0' && number[i] <= '9') ++i;
            return i - start;
        };
        const bool zero = i < number.size() && number[i] == '0';
        const std::size_t whole = digits();
        if (whole == 0 || (zero && whole > 1)) return false;
        if (i < number.size() && number[i] == '.') {
            ++i;
            if (digits() == 0) return false;
        }
        if (i < number.size() && (number[i] == 'e' || number[i] == 'E')) {
            ++i;
            if (i < number.size() && (number[i] == '+' || number[i] == '-')) ++i;
            if (digits() == 0) return false;
        }
        return i == number.size();
    }

    bool read_number(double& number) {
        const std::size_t end = text_.find_first_of(" \t\r\n,:[]{}\"/", at_);
        const std::string_view word = text_.substr(at_, end - at_);
        if (word.size() > most_digits || !is_json_number(word)) return false;
        const auto result = std::from_chars(word.data(), word.data() + word.size(), number);
        at_ += word.size();
        if (word.find_first_of(".eE") == word.npos) number += 0.0;  // -0 is the whole number 0
        return result.ec == std::errc();
    }

    bool read_string(std::string& string) {
        const std::size_t start = at_ + 1;
        std::size_t end = start;
        while (end < text_.size() && text_[end] != '"') {
            if (static_cast<unsigned char>(text_[end]) < 0x20 || text_[end] == '\\') return false;
            ++end;
        }
        if (end == text_.size()) return false;
        string = text_.substr(start, end - start);
        at_ = end + 1;
        return true;
    }

    bool read_array(JsonValue::Array& items, std::size_t depth) {
        ++at_;
        if (depth > max_json_depth) return false;
        if (take(']')) return true;
        do {
            if (items.size() == 1) items.reserve(3);  // vectors and colors, in the main
            if (!read_value(items.emplace_back(), depth)) return false;
        } while (take(','));
        return take(']');
    }

    bool read_object(JsonValue::Object& members, std::size_t depth) {
        ++at_;
        if (depth > max_json_depth) return false;
        if (take('}')) return true;
        do {
            skip_blanks();
            JsonMember& member = members.emplace_back();
            member.key_offset = static_cast<std::uint32_t>(at_);
            if (here() != '"' || !read_string(member.key) || !take(':')) return false;
            if (!read_value(member.value, depth)) return false;
        } while (take(','));
        return take('}') && !has_repeated_key(members);
    }

    /// Compares all pairs of few members; sorts the keys of many.
    static bool has_repeated_key(const JsonValue::Object& members) {
        constexpr std::size_t few = 12;
        if (members.size() > few) {
            std::vector<std::string_view> keys;
            for (const JsonMember& member : members) keys.push_back(member.key);
            std::ranges::sort(keys);
            return std::ranges::adjacent_find(keys) != keys.end();
        }
        for (auto member = members.begin(); member != members.end(); ++member) {
            const auto same = [&](const JsonMember& other) { return other.key == member->key; };
            if (std::find_if(members.begin(), member, same) != member) return true;
        }
        return false;
    }

    static constexpr std::size_t most_digits = 60;

    std::string_view text_;
    std::size_t at_ = 0;
    std::size_t values_ = 0;
};

}  // namespace

std::optional<JsonValue> parse_plain_json(std::string_view text) {
    return PlainReader(text).read();
}

}  // namespace rt
