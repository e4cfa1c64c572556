// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rt {

/// Skips blanks and complete comments; returns the offset of the next character.
std::size_t skip_json_blanks(std::string_view text, std::size_t at);

/// End offset of the token (string, number, word, bracket) that starts at `at`.
std::size_t json_token_end(std::string_view text, std::size_t at);

/// What preceded a syntax error, which determines what may follow.
enum class JsonState { start, object_opened, after_key, in_object, array_opened, in_array, done };

struct JsonSyntaxMistake {
    std::size_t offset = 0;
    std::string message;  ///< "what is wrong; what to do"
};

/// Explains a syntax error in a JSON text that is valid up to `at`. `reader_offset` is where the
/// parser stopped: the exact position of an error within a string.
JsonSyntaxMistake explain_json_syntax(std::string_view text, std::size_t at, JsonState state,
                                      std::size_t reader_offset);

}  // namespace rt
