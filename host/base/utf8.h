// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace rt {

/// The byte order mark that some editors put at the start of a UTF-8 file.
inline constexpr std::string_view utf8_byte_order_mark = "\xEF\xBB\xBF";

/// Continuation bytes belong to the character before them and take no column of their own.
constexpr bool is_utf8_continuation(char c) {
    return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u;
}

/// Bytes of the well-formed character (Unicode 15, table 3-7) at the start of the text; 0 if there
/// is none or it is NUL.
std::size_t utf8_character_length(std::string_view text);

/// Offset of the first NUL or byte that is not well-formed UTF-8 (Unicode 15, table 3-7); empty
/// when the whole text is valid.
std::optional<std::size_t> find_invalid_utf8(std::string_view text);

}  // namespace rt
