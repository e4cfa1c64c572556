// SPDX-License-Identifier: Apache-2.0
#include "host/scene/ply_rows.h"

#include <fmt/format.h>

#include "host/base/text.h"
#include "host/scene/words.h"

namespace rt {

std::string ply_row_name(const PlyElement& element, std::uint64_t row) {
    return fmt::format("element {} {}", in_quotes(element.name), row);
}

/// Ignores a few blank bytes: a line end left by a text editor or a program.
std::string BinaryRows::leftover() {
    constexpr std::uint64_t few = 4;
    const std::uint64_t left = bytes_left();
    const std::string_view rest(at_, left);
    if (left <= few && rest.find_first_not_of("\r\n \t") == rest.npos) return {};
    return fmt::format("ignored {} after the last element", counted(left, "byte"));
}

void TextRows::start_row(const PlyElement& element, std::uint64_t row) {
    element_ = &element;
    row_ = row;
    noted_ = false;
    if (scanner_.find_word()) return;
    mistakes_.add(scanner_.offset(),
                  fmt::format("the file ends before {}, of {}; save the model again",
                              ply_row_name(element, row), element.count));
    lost_ = noted_ = true;
}

void TextRows::end_row() {
    if (!noted_ && scanner_.word_follows()) {
        const std::size_t offset = scanner_.offset();
        mistakes_.add(offset,
                      fmt::format("unexpected {} after the values of {}; remove it",
                                  in_quotes(scanner_.word()), ply_row_name(*element_, row_)));
    }
    scanner_.next_line();
}

bool TextRows::has_word() {
    if (noted_) return false;
    if (scanner_.word_follows()) return true;
    note(fmt::format("the line of {} ends too early; write {} and a line for each row",
                     ply_row_name(*element_, row_), "all values of its properties"));
    noted_ = true;
    return false;
}

std::optional<double> TextRows::number(PlyType) {
    if (!has_word()) return std::nullopt;
    const std::size_t offset = scanner_.offset();
    const auto number = scanner_.number();
    if (number) return number;
    noted_ = true;
    mistakes_.add(offset, fmt::format("a value of {} is {}; write a number",
                                      ply_row_name(*element_, row_), in_quotes(scanner_.word())));
    return std::nullopt;
}

std::optional<std::int64_t> TextRows::integer(PlyType) {
    if (!has_word()) return std::nullopt;
    const std::size_t offset = scanner_.offset();
    const auto number = scanner_.integer();
    if (number) return number;
    noted_ = true;
    mistakes_.add(offset, fmt::format("a value of {} is {}; write a whole number",
                                      ply_row_name(*element_, row_), in_quotes(scanner_.word())));
    return std::nullopt;
}

bool TextRows::skip(PlyType, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
        if (!has_word()) return false;
        scanner_.word();
    }
    return true;
}

std::string TextRows::leftover() {
    if (scanner_.find_word()) {
        note("more lines follow than the header declares; correct its counts");
    }
    return {};
}

}  // namespace rt
