// SPDX-License-Identifier: Apache-2.0
#include "host/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <iterator>

namespace rt {

namespace {

struct Range {
    char32_t first, last;
};

/// Unicode 15: characters that terminals act on, or that make text look like other text.
constexpr Range hidden[] = {{0x00, 0x1F},        {0x7F, 0x9F},                        // C0, DEL, C1
                            {0xAD, 0xAD},                                             // soft hyphen
                            {0x061C, 0x061C},    {0x200E, 0x200F}, {0x202A, 0x202E},  // directions
                            {0x2066, 0x2069},                                         // isolates
                            {0x200B, 0x200B},    {0x2060, 0x2064},                    // zero width
                            {0x2028, 0x2029},                       // line and paragraph separators
                            {0xFEFF, 0xFEFF},    {0xFFF9, 0xFFFB},  // byte order mark, annotations
                            {0xE0000, 0xE007F},                     // tags
                            {0xD800, 0xDFFF},                       // surrogates
                            {0x110000, 0x1FFFFF}};                  // beyond Unicode

}  // namespace

std::size_t printable_length(std::string_view text) {
    if (text.empty()) return 0;
    const auto lead = static_cast<unsigned char>(text[0]);
    const int ones = std::countl_one(lead);  // 0 for ASCII, else the character's bytes
    const auto length = static_cast<std::size_t>(std::max(ones, 1));
    if (ones == 1 || ones > 4 || length > text.size()) return 0;
    char32_t code = lead & (0x7Fu >> ones);
    for (const char c : text.substr(1, length - 1)) {
        if (!is_utf8_continuation(c)) return 0;
        code = code << 6 | (static_cast<unsigned char>(c) & 0x3Fu);
    }
    constexpr char32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    if (code < least[ones]) return 0;  // there is a shorter form
    const auto holds = [&](const Range& range) {
        return code >= range.first && code <= range.last;
    };
    return std::any_of(std::begin(hidden), std::end(hidden), holds) ? 0 : length;
}

std::string printable(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::size_t length = printable_length(text);
        if (length > 0) {
            result += text.substr(0, length);
        } else {
            result += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
        }
        text.remove_prefix(length > 0 ? length : 1);
    }
    return result;
}

std::vector<std::string> split(std::string_view text, char separator) {
    std::vector<std::string> parts;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(separator, at), text.size());
        parts.emplace_back(text.substr(at, end - at));
        at = end + 1;
    }
    return parts;
}

std::string environment(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
}

std::string csv_quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

std::string short_device_name(const std::string& name) {
    return name.starts_with("pthread-") || name.starts_with("cpu-") ? "PoCL" : name;
}

}  // namespace rt
