// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mistakes.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "host/base/error.h"
#include "host/base/text.h"

namespace rt {

SourcePosition position_of(std::string_view text, std::size_t offset) {
    if (text.starts_with(utf8_byte_order_mark)) {
        text.remove_prefix(utf8_byte_order_mark.size());
        offset -= std::min(offset, utf8_byte_order_mark.size());
    }
    const std::string_view before = text.substr(0, std::min(offset, text.size()));
    const std::size_t newline = before.rfind('\n');
    const std::string_view line =
        newline == std::string_view::npos ? before : before.substr(newline + 1);
    const auto characters =
        std::count_if(line.begin(), line.end(), [](char c) { return !is_utf8_continuation(c); });
    const auto lines = std::count(before.begin(), before.end(), '\n');
    return {static_cast<std::size_t>(lines) + 1, static_cast<std::size_t>(characters) + 1};
}

Mistakes::Mistakes(std::string_view text, std::string_view file_name)
    : text_(text), file_name_(printable(file_name)) {}

void Mistakes::add(std::size_t offset, std::string message) {
    add_in({}, offset, std::move(message));
}

void Mistakes::add_in(std::string where, std::size_t offset, std::string message) {
    if (is_part_ && is_full()) return;
    found_.push_back({offset, std::move(message), std::move(where)});
    if (!is_part_ && is_full()) throw_if_any();
}

Mistakes Mistakes::part() const {
    Mistakes part(text_, file_name_);
    part.is_part_ = true;
    return part;
}

void Mistakes::add_all(const Mistakes& part) {
    found_.insert(found_.end(), part.found_.begin(), part.found_.end());
}

std::string Mistakes::place(std::size_t offset) const {
    const SourcePosition position = position_of(text_, offset);
    return fmt::format("{}:{}:{}", file_name_, position.line, position.column);
}

void Mistakes::throw_if_any() const {
    if (found_.empty()) return;
    std::vector<Mistake> sorted = found_;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const Mistake& a, const Mistake& b) { return a.offset < b.offset; });
    if (sorted.size() > max_count) sorted.erase(sorted.begin() + max_count, sorted.end());
    std::string lines;
    for (const Mistake& mistake : sorted) {
        if (!lines.empty()) lines += '\n';
        lines += mistake.where.empty() ? place(mistake.offset) : file_name_ + ": " + mistake.where;
        lines += ": " + mistake.message;
    }
    throw Error(ExitCode::input, lines);
}

}  // namespace rt
