// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rt {

/// "line:column": both count from 1; a column is one Unicode code point, tabs included.
std::string position_of(std::string_view text, std::size_t offset);

/// What is done about a blemish, to be counted: "face left out", "faces left out".
struct Remedy {
    const char *one, *many;
};

/// Collects what is wrong in one text file, so that its author sees several things at once: errors,
/// and notes on blemishes that do not keep the file from being read. The text must outlive it.
class Mistakes {
   public:
    static constexpr std::size_t max_count = 20;

    Mistakes(std::string_view text, std::string_view file_name);

    /// Adds an error, "what is wrong; what to do", at a byte offset. Throws when max_count is
    /// reached.
    template <typename... Args>
    void add(std::size_t offset, fmt::format_string<Args...> message, Args&&... args) {
        report(nullptr, offset, fmt::format(message, std::forward<Args>(args)...));
    }

    /// How many errors there are.
    std::size_t count() const;

    /// Notes a blemish. Of those with the same remedy, the first is kept and all are counted, so
    /// that a million of them are one line.
    template <typename... Args>
    void note(const Remedy& remedy, std::size_t offset, fmt::format_string<Args...> message,
              Args&&... args) {
        report(&remedy, offset, fmt::format(message, std::forward<Args>(args)...));
    }

    /// Notes a blemish or, without a remedy, adds an error. A `count` of 0 only gives the reason
    /// for later ones. `where` ("element 'face' 17") replaces line and column, for data without
    /// lines.
    void report(const Remedy* remedy, std::size_t offset, std::string message,
                std::size_t count = 1, std::string where = {});

    bool is_empty() const { return found_.empty(); }

    /// Takes over the notes of a later part of the same text.
    void take_notes(const Mistakes& part);

    /// "file:line:column: message (3 faces left out)", in file order.
    std::vector<std::string> notes() const { return lines(true); }

    /// Throws the notes as errors, if there are any: they are why nothing is left.
    void refuse_notes();

    std::string_view text() const { return text_; }
    const std::string& file_name() const { return file_name_; }

    /// "file:line:column", for a message that points at a second place.
    std::string place(std::size_t offset) const;

    /// Throws Error(ExitCode::input) with one line per mistake, in file order, if there are any.
    void throw_if_any() const;

   private:
    struct Mistake {
        std::size_t offset;
        std::string message;
        std::string where;     ///< empty: use line and column of the offset
        const Remedy* remedy;  ///< null: an error
        std::size_t count;     ///< of notes with this remedy, of which this is the first
    };

    /// In file order: the notes, or the errors.
    std::vector<std::string> lines(bool are_notes) const;

    std::string_view text_;
    std::string file_name_;
    std::vector<Mistake> found_;
};

}  // namespace rt
