// SPDX-License-Identifier: Apache-2.0
#include "host/base/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "host/base/utf8.h"

namespace rt {
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

}  // namespace rt
