// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace rt {

/// Where a pixel is sampled: an n x n regular grid with offsets (i + 0.5) / n from the pixel's
/// corner. `none` is n = 1, the pixel centre; n = 2 is the paper's four buffers at .25 and .75.
struct AaMode {
    static constexpr int max_grid = 64;

    int grid = 2;

    int samples() const { return grid * grid; }
    bool operator==(const AaMode&) const = default;
};

/// "none" or "grid:N" with N in 1..64; empty when the text is neither.
std::optional<AaMode> parse_aa_mode(std::string_view text);

/// The text that parse_aa_mode reads back.
std::string to_string(AaMode mode);

}  // namespace rt
