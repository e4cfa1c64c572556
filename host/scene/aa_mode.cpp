// SPDX-License-Identifier: Apache-2.0
#include "host/scene/aa_mode.h"

#include <fmt/format.h>

#include <algorithm>

namespace rt {
namespace {

constexpr Named<AaMode::Pattern> pattern_names[] = {{"grid", AaMode::Pattern::grid},
                                                    {"sobol", AaMode::Pattern::sobol},
                                                    {"adaptive", AaMode::Pattern::adaptive},
                                                    {"edges", AaMode::Pattern::edges}};

}  // namespace

int AaMode::samples() const { return pattern == Pattern::grid ? count * count : count; }

AaMode grid_aa(int n) { return {AaMode::Pattern::grid, n, 0}; }

std::optional<AaMode> parse_aa_mode(std::string_view text) {
    if (text == "none") return grid_aa(1);
    const std::size_t colon = std::min(text.find(':'), text.size());
    const auto pattern = value_of(pattern_names, text.substr(0, colon));
    if (!pattern || colon == text.size()) return std::nullopt;
    const std::string_view number = text.substr(colon + 1);
    AaMode mode{*pattern, 1, 0};
    if (mode.refines() || mode.finds_edges()) {
        const double least = mode.refines() ? AaMode::min_threshold : AaMode::min_tolerance;
        mode.threshold = parse_number<double>(number).value_or(0);
        if (!(mode.threshold >= least && mode.threshold <= 1)) return std::nullopt;
    } else {
        const int most =
            mode.pattern == AaMode::Pattern::grid ? AaMode::max_grid : AaMode::max_sobol;
        mode.count = parse_number<int>(number).value_or(0);
        if (mode.count < 1 || mode.count > most) return std::nullopt;
    }
    return mode;
}

std::string to_string(const AaMode& mode) {
    if (mode == grid_aa(1)) return "none";
    const char* const name = name_of(pattern_names, mode.pattern);
    return mode.refines() || mode.finds_edges() ? fmt::format("{}:{}", name, mode.threshold)
                                                : fmt::format("{}:{}", name, mode.count);
}

}  // namespace rt
