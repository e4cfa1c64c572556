// SPDX-License-Identifier: Apache-2.0
#include "host/options/guess.h"

#include <algorithm>
#include <utility>

namespace rt {

namespace {

/// Edit distance: letters to insert, drop, replace, or swap with their neighbor.
std::size_t edits_between(const std::string& a, const std::string& b) {
    std::vector<std::size_t> before, row(b.size() + 1), next(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        next[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = row[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            next[j] = std::min({row[j] + 1, next[j - 1] + 1, replaced});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) next[j] = std::min(next[j], before[j - 2] + 1);
        }
        before = row;
        std::swap(row, next);
    }
    return row.back();
}

}  // namespace

std::string guess_text(const std::string& word, const std::vector<std::string>& known) {
    const std::size_t most = std::max<std::size_t>(word.size() / 3, 1);
    std::pair<std::size_t, std::string> best{most + 1, ""};
    for (const std::string& candidate : known) {
        const bool begins = word.size() > 3 && candidate.starts_with(word);
        best = std::min(best, {begins ? 0 : edits_between(word, candidate), candidate});
    }
    return best.first > most ? "" : "; did you mean '" + best.second + "'?";
}

}  // namespace rt
