// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace rt {

/// What some editors put in front of a UTF-8 file.
inline constexpr std::string_view utf8_byte_order_mark = "\xEF\xBB\xBF";

/// Continuation bytes belong to the character before them and take no column of their own.
constexpr bool is_utf8_continuation(char c) {
    return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u;
}

/// Bytes of the well-formed character (Unicode 15, table 3-7) that the text starts with; 0 where
/// none does, a NUL included.
std::size_t utf8_character_length(std::string_view text);

/// Where the text stops being well-formed UTF-8 (Unicode 15, table 3-7), a NUL byte included;
/// empty when all of it is good.
std::optional<std::size_t> find_invalid_utf8(std::string_view text);

}  // namespace rt
