// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/base/parallel.h"
#include "host/base/text.h"
#include "host/scene/mistakes.h"
#include "host/scene/words.h"

namespace rt {

/// Reads a text whose statements are lines of words (OBJ, MTL, PLY). Lines end with \n, \r\n or
/// \r; a backslash before the end of a line joins it to the next; # ends the
/// line. Nothing is copied.
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
    /// Skips blanks; the offset of the next word of this line, or of its end.
    std::size_t word_offset() {
        word_follows();
        return offset();
    }
    /// The next word of this line, empty at its end.
    std::string_view word();
    /// The rest of this line, trimmed (continuations and comments are not handled).
    std::string_view rest();
    /// Goes to the start of the next line.
    void next_line();
    /// Skips empty lines and comments; returns whether there is another word.
    bool find_word();

    /// Reads the next word if it is a number. Otherwise, and for infinities and NaN unless asked
    /// for, consumes nothing and returns nothing; underflow gives 0.
    std::optional<double> number(bool may_be_infinite = false);
    std::optional<std::int64_t> integer();

   private:
    bool at_line_end() const { return at_ == end_ || *at_ == '\n' || *at_ == '\r'; }
    std::size_t continuation() const;
    bool skip_plain_line();
    bool at_word_end() const;

    const char *begin_, *at_, *end_;
};

/// What stands where a number was wanted, for messages: a number, or a word, which it skips, or
/// nothing.
template <typename Number>
std::string found_text(LineScanner& scanner, const std::optional<Number>& number) {
    if (number) return fmt::format("{}", *number);
    const std::string_view word = scanner.word();
    return word.empty() ? "missing" : in_quotes(word);
}

/// The next number, within max_scene_number. Otherwise nothing, and a note (or, without a remedy,
/// an error) says why; a word that is no number is skipped. `name` is what messages call it.
std::optional<double> scan_number(LineScanner& scanner, std::string_view name, Mistakes& mistakes,
                                  const Remedy* remedy = nullptr, std::size_t count = 1);

/// How a large file is read: with how many threads, in chunks of about how many bytes. Neither
/// affects the result or the notes.
struct ReadPace {
    int threads = available_cores();
    std::size_t chunk_bytes = std::size_t{1} << 20;
};

/// Offsets at which a text of lines may be split, including 0 and its end: after a line feed that
/// is not escaped by a backslash.
std::vector<std::size_t> line_cuts(std::string_view text, std::size_t chunk_bytes);

}  // namespace rt
