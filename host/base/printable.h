// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rt {

/// Bytes of the text's first character if it is safe to show, else 0: control characters (C0, C1),
/// invalid UTF-8, line separators, and characters that are invisible or change the writing
/// direction.
std::size_t printable_length(std::string_view text);

/// Makes untrusted text, such as a file or device name, safe for messages and tables: each
/// unprintable byte becomes "\xNN". It cannot break a line or send the terminal escape sequences.
std::string printable(std::string_view text);

}  // namespace rt
