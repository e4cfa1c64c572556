// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "host/scene/mistakes.h"
#include "host/utf8.h"

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

    /// Where the next character stands in the text.
    std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }
    std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }

    /// What is not read yet, for who reads a word in another way, and goes past it.
    std::string_view left() const { return {at_, bytes_left()}; }
    void advance(std::size_t bytes) { at_ += bytes; }

    /// Skips blanks; whether a word follows on this line.
    bool word_follows();
    /// The next word of this line, empty at its end.
    std::string_view word();
    /// What is left of this line (no continuation, no comments), without blanks around it.
    std::string_view rest();
    /// Goes to the start of the next line.
    void next_line();
    /// Skips empty lines and comments; whether a word follows somewhere.
    bool find_word();

    /// The word ahead as a number, or nothing: then it is still ahead. Infinities and numbers
    /// that are none are nothing too; one that is too small to tell from 0 is 0.
    std::optional<double> number();
    std::optional<std::int64_t> integer();

   private:
    bool at_line_end() const { return at_ == end_ || *at_ == '\n' || *at_ == '\r'; }
    std::size_t continuation() const;
    bool skip_plain_line();
    bool at_word_end() const;

    const char *begin_, *at_, *end_;
};

/// The number ahead, within max_scene_number; notes what is there instead. `name` is what
/// messages call it: "a coordinate".
std::optional<double> read_number(LineScanner& scanner, std::string_view name, Mistakes& mistakes);

}  // namespace rt
