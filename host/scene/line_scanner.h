// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "host/base/text.h"
#include "host/scene/mistakes.h"

namespace rt {

/// Reads a text whose statements are lines of words (OBJ, MTL, PLY). Lines end with \n, \r\n or
/// \r; a backslash before the end of a line joins it to the next; a word that starts with # ends
/// the line. Nothing is copied.
class LineScanner {
   public:
    explicit LineScanner(std::string_view text, std::size_t start = 0)
        : begin_(text.data()), at_(begin_ + start), end_(begin_ + text.size()) {
        if (start == 0 && text.starts_with(utf8_byte_order_mark)) {
            at_ += utf8_byte_order_mark.size();
        }
    }

    /// The current offset in the text.
    std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }
    std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }

    /// The unread text, for callers that parse a word themselves and then advance past it.
    std::string_view left() const { return {at_, bytes_left()}; }
    void advance(std::size_t bytes) { at_ += bytes; }

    /// Skips blanks; whether a word follows on this line.
    bool word_follows();
    /// The next word of this line, empty at its end.
    std::string_view word();
    /// The rest of this line, trimmed (continuations and comments are not handled).
    std::string_view rest();
    /// Goes to the start of the next line.
    void next_line();
    /// Skips empty lines and comments; returns whether there is another word.
    bool find_word();

    /// Reads the next word if it is a number. Otherwise, and for infinities and NaN, consumes
    /// nothing and returns nothing; underflow gives 0.
    std::optional<double> number();
    std::optional<std::int64_t> integer();

   private:
    bool at_line_end() const { return at_ == end_ || *at_ == '\n' || *at_ == '\r'; }
    std::size_t continuation() const;
    bool skip_plain_line();
    bool at_word_end() const;

    const char *begin_, *at_, *end_;
};

/// The next number, within max_scene_number; notes anything else. `name` is what messages call it:
/// "a coordinate".
std::optional<double> read_number(LineScanner& scanner, std::string_view name, Mistakes& mistakes);

}  // namespace rt
