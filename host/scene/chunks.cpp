// SPDX-License-Identifier: Apache-2.0
#include "host/scene/chunks.h"

#include <algorithm>

namespace rt {
namespace {

/// Offset after the first unescaped line feed at or after `at`; the text's end if there is none.
std::size_t next_cut(std::string_view text, std::size_t at) {
    while (true) {
        const std::size_t feed = text.find('\n', at);
        if (feed == text.npos) return text.size();
        const std::string_view before = text.substr(0, feed);
        const bool joined = before.ends_with('\\') || before.ends_with("\\\r");
        if (!joined) return feed + 1;
        at = feed + 1;
    }
}

}  // namespace

std::vector<std::size_t> line_cuts(std::string_view text, std::size_t chunk_bytes) {
    std::vector<std::size_t> cuts{0};
    while (cuts.back() < text.size()) {
        const std::size_t at = std::min(cuts.back() + chunk_bytes, text.size()) - 1;
        cuts.push_back(next_cut(text, at));
    }
    return cuts;
}

}  // namespace rt
