// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace rt {

/// 'text' for a message, made printable and truncated if long.
std::string in_quotes(std::string_view text);

/// The known word closest to a misspelled one, or else one that contains it; an empty view when
/// there is none.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> known);

/// What a mistyped word may have meant: "; did you mean '--size'?", or "" if nothing is close.
std::string guess_text(const std::string& word, const std::vector<std::string>& known);

/// Advice on an unknown word: "did you mean 'x'?" or, when none is close, `otherwise` and the known
/// words.
std::string suggestion(std::string_view word, std::span<const std::string_view> known,
                       std::string_view otherwise);

/// 'a', 'b' and 'c', cut after the first few.
std::string word_list(std::span<const std::string_view> words);

}  // namespace rt
