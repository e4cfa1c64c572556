// SPDX-License-Identifier: Apache-2.0
#include "host/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iterator>

namespace rt {

/// The second byte's narrower ranges keep out overlong forms, surrogates, and anything above
/// U+10FFFF.
std::size_t utf8_character_length(std::string_view text) {
    const auto byte = [&](std::size_t i) -> unsigned {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
    };
    const unsigned lead = byte(0);
    if (lead < 0x80) return lead == 0 ? 0 : 1;
    if (lead < 0xC2 || lead > 0xF4) return 0;
    const std::size_t length = lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
    unsigned low = 0x80, high = 0xBF;
    if (lead == 0xE0) low = 0xA0;
    if (lead == 0xED) high = 0x9F;
    if (lead == 0xF0) low = 0x90;
    if (lead == 0xF4) high = 0x8F;
    if (byte(1) < low || byte(1) > high) return 0;
    for (std::size_t i = 2; i < length; ++i) {
        if (byte(i) < 0x80 || byte(i) > 0xBF) return 0;
    }
    return length;
}

namespace {

/// Whether the next 8 bytes are ASCII and none is 0.
bool starts_with_ascii(std::string_view text) {
    constexpr std::uint64_t ones = 0x0101010101010101u, tops = 0x8080808080808080u;
    std::uint64_t bytes = 0;
    if (text.size() < sizeof bytes) return false;
    std::memcpy(&bytes, text.data(), sizeof bytes);
    return ((bytes | (bytes - ones)) & tops) == 0;
}

}  // namespace

std::optional<std::size_t> find_invalid_utf8(std::string_view text) {
    std::size_t at = 0;
    while (at < text.size()) {
        if (starts_with_ascii(text.substr(at))) {
            at += 8;
            continue;
        }
        const std::size_t length = utf8_character_length(text.substr(at));
        if (length == 0) return at;
        at += length;
    }
    return std::nullopt;
}

namespace {

struct Range {
    char32_t first, last;
};

/// Unicode 15: characters that terminals act on, or that make text look like other text.
constexpr Range hidden[] = {{0x00, 0x1F},      {0x7F, 0x9F},                        // C0, DEL, C1
                            {0xAD, 0xAD},                                           // soft hyphen
                            {0x061C, 0x061C},  {0x200E, 0x200F}, {0x202A, 0x202E},  // directions
                            {0x2066, 0x2069},                                       // isolates
                            {0x200B, 0x200B},  {0x2060, 0x2064},                    // zero width
                            {0x2028, 0x2029},                     // line and paragraph separators
                            {0xFEFF, 0xFEFF},  {0xFFF9, 0xFFFB},  // byte order mark, annotations
                            {0xE0000, 0xE007F}};                  // tags

char32_t decode(std::string_view character) {
    const auto lead = static_cast<unsigned char>(character[0]);
    if (character.size() == 1) return lead;
    char32_t code = lead & (0x7Fu >> character.size());
    for (const char c : character.substr(1))
        code = code << 6 | (static_cast<unsigned char>(c) & 0x3Fu);
    return code;
}

}  // namespace

std::size_t printable_length(std::string_view text) {
    const std::size_t length = utf8_character_length(text);
    if (length == 0) return 0;
    const char32_t code = decode(text.substr(0, length));
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
