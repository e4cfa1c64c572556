// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rt {

/// Bytes of the character at the start of a text that may be shown as it is; 0 where there is none:
/// control characters (C0, C1), bytes that are not UTF-8, line separators, and what turns the
/// direction of writing or is invisible.
std::size_t printable_length(std::string_view text);

/// Text from outside, such as a file's name or a device's, for messages and tables: each byte of
/// what may not be shown becomes "\xNN". So it breaks no line and does not talk to the terminal.
std::string printable(std::string_view text);

}  // namespace rt
