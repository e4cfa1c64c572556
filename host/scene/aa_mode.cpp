// SPDX-License-Identifier: Apache-2.0
#include "host/scene/aa_mode.h"

#include <charconv>

namespace rt {

std::optional<AaMode> parse_aa_mode(std::string_view text) {
    if (text == "none") return AaMode{1};
    constexpr std::string_view prefix = "grid:";
    if (!text.starts_with(prefix)) return std::nullopt;
    text.remove_prefix(prefix.size());
    int n = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    if (n < 1 || n > AaMode::max_grid) return std::nullopt;
    return AaMode{n};
}

std::string to_string(AaMode mode) {
    return mode.grid == 1 ? "none" : "grid:" + std::to_string(mode.grid);
}

}  // namespace rt
