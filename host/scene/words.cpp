// SPDX-License-Identifier: Apache-2.0
#include "host/scene/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "host/base/text.h"

namespace rt {
namespace {

constexpr std::size_t max_quoted_bytes = 60;
constexpr std::size_t max_words = 16;

/// Edits (insert, delete, replace, swap neighbors) between two words: the restricted distance of
/// Damerau 1964.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    const auto same = [&](std::size_t i, std::size_t j) { return a[i - 1] == b[j - 1]; };
    std::vector<std::size_t> before, above, row(b.size() + 1);
    for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before = above;
        above = row;
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({above[j - 1] + (same(i, j) ? 0 : 1), above[j] + 1, row[j - 1] + 1});
            const bool swapped = i > 1 && j > 1 && same(i, j - 1) && same(i - 1, j);
            if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
        }
    }
    return row[b.size()];
}

}  // namespace

std::string in_quotes(std::string_view text) {
    std::size_t size = std::min(text.size(), max_quoted_bytes);
    while (size > 0 && size < text.size() && is_utf8_continuation(text[size])) --size;
    return fmt::format("'{}{}'", printable(text.substr(0, size)), size < text.size() ? "..." : "");
}

std::string_view nearest_word(std::string_view word, std::span<const std::string_view> known) {
    if (word.size() > max_quoted_bytes) return {};
    std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
    std::string_view best;
    for (const std::string_view candidate : known) {
        if (candidate.size() > word.size() + best_distance) continue;
        const std::size_t distance =
            edit_distance(lower(std::string(word)), lower(std::string(candidate)));
        if (distance < best_distance && distance < candidate.size()) {
            best_distance = distance;
            best = candidate;
        }
    }
    const auto contains = [&](std::string_view name) { return name.find(word) != name.npos; };
    if (!best.empty() || word.size() < 3) return best;
    const auto longer = std::ranges::find_if(known, contains);
    return longer == known.end() ? best : *longer;
}

std::string guess_text(const std::string& word, const std::vector<std::string>& known) {
    const std::vector<std::string_view> names(known.begin(), known.end());
    const std::string_view guess = nearest_word(word, names);
    return guess.empty() ? "" : fmt::format("; did you mean '{}'?", guess);
}

std::string suggestion(std::string_view word, std::span<const std::string_view> known,
                       std::string_view otherwise) {
    const std::string_view near = nearest_word(word, known);
    if (!near.empty()) return fmt::format("did you mean {}?", in_quotes(near));
    return fmt::format("{} {}", otherwise, word_list(known));
}

std::string word_list(std::span<const std::string_view> words) {
    std::string result;
    const std::size_t shown = std::min(words.size(), max_words);
    for (std::size_t i = 0; i < shown; ++i) {
        if (i > 0) result += i + 1 == words.size() ? " and " : ", ";
        result += in_quotes(words[i]);
    }
    if (shown < words.size()) result += fmt::format(" and {} more", words.size() - shown);
    return result;
}

}  // namespace rt
