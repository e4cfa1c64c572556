// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "host/base/text.h"

namespace rt {

/// How a pixel is sampled.
struct AaMode {
    enum class Pattern {
        grid,      ///< count x count regular positions, (i + 0.5) / count from the pixel's corner
        sobol,     ///< count Owen-scrambled Sobol samples
        adaptive,  ///< one sample, then finer grids where neighbors differ by more than threshold
        edges,     ///< one sample, then samples on lines where it finds edges (kernels/edges.cl)
    };

    static constexpr int max_grid = 64;
    static constexpr int max_sobol = 4096;
    static constexpr double min_threshold = 1e-4, min_tolerance = 1e-5;

    Pattern pattern = Pattern::grid;
    int count = 2;         ///< grid 2 is the paper's four buffers at .25 and .75
    double threshold = 0;  ///< adaptive: channel difference, clamped to 0..1; edges: tolerance

    /// Samples per pixel; in adaptive and edges modes, of the first round.
    int samples() const;

    /// Samples per pixel where every pixel has as many.
    std::optional<int> fixed_samples() const {
        return threshold > 0 ? std::nullopt : std::optional(samples());
    }

    bool refines() const { return pattern == Pattern::adaptive; }

    bool finds_edges() const { return pattern == Pattern::edges; }

    bool operator==(const AaMode&) const = default;
};

AaMode grid_aa(int n);

/// "none" (the pixel center), "grid:N" with N in 1..64, "sobol:S" with S in 1..4096, "adaptive:T"
/// with T in 0.0001..1, or "edges:T" with T in 0.00001..1; empty when the text is none of these.
std::optional<AaMode> parse_aa_mode(std::string_view text);

/// The modes that parse_aa_mode accepts, for messages.
inline constexpr const char* aa_mode_help =
    "none, grid:N (N from 1 to 64), sobol:S (S from 1 to 4096), adaptive:T (T from 0.0001 to 1) or "
    "edges:T (T from 0.00001 to 1)";

/// The text that parse_aa_mode reads back.
std::string to_string(const AaMode& mode);

template <typename Json>
void to_json(Json& json, const AaMode& mode) {
    json = to_string(mode);
}
template <typename Json>
void from_json(const Json& json, AaMode& mode) {
    mode = parse_aa_mode(json.template get<std::string>()).value();
}

/// How a pixel's samples are weighted (kernels/sampling.cl).
enum class Filter { box, tent, gaussian, mitchell };

inline constexpr Named<Filter> filter_names[] = {{"box", Filter::box},
                                                 {"tent", Filter::tent},
                                                 {"gaussian", Filter::gaussian},
                                                 {"mitchell", Filter::mitchell}};

constexpr auto& enum_names(Filter) { return filter_names; }
inline const char* to_string(Filter filter) { return name_of(filter_names, filter); }

}  // namespace rt
