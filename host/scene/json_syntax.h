// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rt {

/// Where the next character stands that is neither blank nor in a complete comment.
std::size_t skip_json_blanks(std::string_view text, std::size_t at);

/// Just after the token (string, number, word, bracket) that starts at `at`.
std::size_t json_token_end(std::string_view text, std::size_t at);

/// What came last before a syntax mistake, hence what may follow.
enum class JsonState { start, object_opened, after_key, in_object, array_opened, in_array, done };

struct JsonSyntaxMistake {
    std::size_t offset = 0;
    std::string message;  ///< "what is wrong; what to do"
};

/// Explains why a JSON text that is good up to `at` cannot go on. `reader_offset` is where the
/// reader gave up: the exact place of a mistake within a string.
JsonSyntaxMistake explain_json_syntax(std::string_view text, std::size_t at, JsonState state,
                                      std::size_t reader_offset);

}  // namespace rt
