// SPDX-License-Identifier: Apache-2.0
#include "host/scene/aa_mode.h"

#include <fmt/format.h>

namespace rt {

namespace {

std::optional<AaMode> with_count(AaMode::Pattern pattern, std::string_view text, int most) {
    const auto count = parse_number<int>(text);
    if (!count || *count < 1 || *count > most) return std::nullopt;
    return AaMode{pattern, *count, 0};
}

std::optional<AaMode> with_threshold(AaMode::Pattern pattern, std::string_view text) {
    const auto threshold = parse_number<double>(text);
    const AaMode mode{pattern, 1, threshold.value_or(0)};
    const double least = mode.finds_edges() ? AaMode::min_tolerance : AaMode::min_threshold;
    if (!(mode.threshold >= least && mode.threshold <= 1)) return std::nullopt;
    return mode;
}

}  // namespace

int AaMode::samples() const { return pattern == Pattern::grid ? count * count : count; }

AaMode grid_aa(int n) { return {AaMode::Pattern::grid, n, 0}; }

std::optional<AaMode> parse_aa_mode(std::string_view text) {
    if (text == "none") return grid_aa(1);
    const auto colon = text.find(':');
    if (colon == std::string_view::npos) return std::nullopt;
    const std::string_view name = text.substr(0, colon), value = text.substr(colon + 1);
    if (name == "grid") return with_count(AaMode::Pattern::grid, value, AaMode::max_grid);
    if (name == "sobol") return with_count(AaMode::Pattern::sobol, value, AaMode::max_sobol);
    if (name == "adaptive") return with_threshold(AaMode::Pattern::adaptive, value);
    if (name == "edges") return with_threshold(AaMode::Pattern::edges, value);
    return std::nullopt;
}

std::string to_string(const AaMode& mode) {
    switch (mode.pattern) {
        case AaMode::Pattern::grid:
            return mode.count == 1 ? "none" : fmt::format("grid:{}", mode.count);
        case AaMode::Pattern::sobol:
            return fmt::format("sobol:{}", mode.count);
        case AaMode::Pattern::adaptive:
            return fmt::format("adaptive:{}", mode.threshold);
        case AaMode::Pattern::edges:
            return fmt::format("edges:{}", mode.threshold);
    }
    return "";
}

}  // namespace rt
