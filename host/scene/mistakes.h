// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace rt {

/// Both count from 1; a column is one Unicode code point, tabs included.
struct SourcePosition {
    std::size_t line = 1, column = 1;
};

SourcePosition position_of(std::string_view text, std::size_t offset);

/// Collects the errors in one text file, so that its author sees several at once. The text must
/// outlive it.
class Mistakes {
   public:
    static constexpr std::size_t max_count = 20;

    Mistakes(std::string_view text, std::string_view file_name);

    /// Notes "what is wrong; what to do" at a byte offset. Throws when max_count is reached.
    void add(std::size_t offset, std::string message);

    /// The same for data without lines: `where` ("element 'face' 17") replaces line and column in
    /// the message.
    void add_in(std::string where, std::size_t offset, std::string message);

    std::size_t count() const { return found_.size(); }

    /// An empty one for a part of the same text: it keeps its first max_count and never throws.
    Mistakes part() const;
    bool is_full() const { return found_.size() >= max_count; }

    /// Takes over a part's mistakes without throwing; throw_if_any then reports the file's first
    /// max_count.
    void add_all(const Mistakes& part);

    std::string_view text() const { return text_; }

    /// "file:line:column", for a message that points at a second place.
    std::string place(std::size_t offset) const;

    /// Throws Error(ExitCode::input) with one line per mistake, in file order, if there are any.
    void throw_if_any() const;

   private:
    struct Mistake {
        std::size_t offset;
        std::string message;
        std::string where;  ///< empty: use line and column of the offset
    };

    std::string_view text_;
    std::string file_name_;
    bool is_part_ = false;
    std::vector<Mistake> found_;
};

}  // namespace rt
