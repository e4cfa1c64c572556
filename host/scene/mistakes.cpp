// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mistakes.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "host/base/error.h"
#include "host/base/text.h"

namespace rt {

std::string position_of(std::string_view text, std::size_t offset) {
    if (text.starts_with(utf8_byte_order_mark)) {
        text.remove_prefix(utf8_byte_order_mark.size());
        offset -= std::min(offset, utf8_byte_order_mark.size());
    }
    const std::string_view before = text.substr(0, std::min(offset, text.size()));
    auto lines = std::count(before.begin(), before.end(), '\n');
    std::size_t start = before.rfind('\n') + 1;
    for (auto at = before.find('\r'); at != before.npos; at = before.find('\r', at + 1)) {
        if (text.substr(at + 1, 1) == "\n") continue;
        ++lines;
        start = std::max(start, at + 1);
    }
    const auto characters = std::ranges::count_if(before.substr(start),
                                                  [](char c) { return !is_utf8_continuation(c); });
    return fmt::format("{}:{}", lines + 1, characters + 1);
}

Mistakes::Mistakes(std::string_view text, std::string_view file_name)
    : text_(text), file_name_(printable(file_name)) {}

void Mistakes::report(const Remedy* remedy, std::size_t offset, std::string message,
                      std::size_t count, std::string where) {
    const auto same = std::ranges::find(found_, remedy, &Mistake::remedy);
    if (remedy && same != found_.end()) {
        same->count += count;
        return;
    }
    found_.push_back({offset, std::move(message), std::move(where), remedy, count});
    if (!remedy && this->count() >= max_count) throw_if_any();
}

std::size_t Mistakes::count() const {
    return static_cast<std::size_t>(std::ranges::count(found_, nullptr, &Mistake::remedy));
}

void Mistakes::take_notes(const Mistakes& part) {
    for (const auto& [offset, message, where, remedy, count] : part.found_) {
        report(remedy, offset, message, count, where);
    }
}

void Mistakes::refuse_notes() {
    for (Mistake& note : found_) note.remedy = nullptr;
    throw_if_any();
}

std::string Mistakes::place(std::size_t offset) const {
    return file_name_ + ":" + position_of(text_, offset);
}

std::vector<std::string> Mistakes::lines(bool are_notes) const {
    std::vector<Mistake> sorted;
    std::ranges::copy_if(found_, std::back_inserter(sorted), [&](const Mistake& mistake) {
        return are_notes ? mistake.remedy && mistake.count > 0 : !mistake.remedy;
    });
    std::ranges::stable_sort(sorted, {}, &Mistake::offset);
    std::vector<std::string> lines;
    for (const auto& [offset, message, where, remedy, count] : sorted) {
        std::string& line =
            lines.emplace_back(where.empty() ? place(offset) : file_name_ + ": " + where);
        line += ": " + message;
        if (remedy) line += fmt::format(" ({})", counted(count, remedy->one, remedy->many));
    }
    return lines;
}

void Mistakes::throw_if_any() const {
    const std::vector<std::string> errors = lines(false);
    if (!errors.empty()) throw Error(ExitCode::input, fmt::format("{}", fmt::join(errors, "\n")));
}

}  // namespace rt
