// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mistakes.h"

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
    Mistake mistake{offset, std::move(message), std::move(where)};
    const auto same = std::ranges::find(notes_, remedy, &Note::remedy);
    if (!remedy) {
        found_.push_back(std::move(mistake));
        if (found_.size() >= max_count) throw_if_any();
    } else if (same != notes_.end()) {
        same->count += count;
    } else {
        notes_.push_back({std::move(mistake), remedy, count});
    }
}

void Mistakes::take_notes(const Mistakes& part) {
    for (const auto& [first, remedy, count] : part.notes_) {
        report(remedy, first.offset, first.message, count, first.where);
    }
}

std::vector<std::string> Mistakes::notes() const {
    std::vector<Note> sorted;
    std::ranges::copy_if(notes_, std::back_inserter(sorted), &Note::count);
    std::ranges::stable_sort(sorted, {}, [](const Note& note) { return note.first.offset; });
    std::vector<std::string> lines;
    for (const Note& note : sorted) {
        lines.push_back(fmt::format("{} ({})", line(note.first),
                                    counted(note.count, note.remedy->one, note.remedy->many)));
    }
    return lines;
}

void Mistakes::refuse_notes() {
    for (const Note& note : notes_) found_.push_back(note.first);
    throw_if_any();
}

std::string Mistakes::place(std::size_t offset) const {
    return file_name_ + ":" + position_of(text_, offset);
}

std::string Mistakes::line(const Mistake& mistake) const {
    const std::string where =
        mistake.where.empty() ? place(mistake.offset) : file_name_ + ": " + mistake.where;
    return where + ": " + mistake.message;
}

void Mistakes::throw_if_any() const {
    if (found_.empty()) return;
    std::vector<Mistake> sorted = found_;
    std::ranges::stable_sort(sorted, {}, &Mistake::offset);
    std::string lines;
    for (const Mistake& mistake : sorted) {
        if (!lines.empty()) lines += '\n';
        lines += line(mistake);
    }
    throw Error(ExitCode::input, lines);
}

}  // namespace rt
