// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/render/rect.h"

namespace rt {

/// Some of the shares that a picture is cut into: those of one machine. A picture with one share is
/// not divided.
struct Shares {
    static constexpr int most = 100000;

    std::vector<int> numbers{0};  ///< ascending, from 0 to of - 1
    int of = 1;

    bool operator==(const Shares&) const = default;
};

/// Numbers from 0 to `most` and ranges of them, separated by commas: "7,9,20-25"; ascending. Empty
/// when the text is anything else.
std::optional<std::vector<int>> parse_ranges(std::string_view text, int most);

/// "7/64" or "7,9,20-25/64"; empty when the text is anything else.
std::optional<Shares> parse_shares(std::string_view text);

/// The text that parse_shares reads back.
std::string to_string(const Shares& shares);

/// The blocks that the shares of a region are made of, row by row, about a thousand of them:
/// squares of 16, 32, 64, 128 or 256 pixels, smaller at the edges.
std::vector<Rect> share_blocks(const Rect& region);

/// The share of each block: equally many blocks per share, at random (always the same way), since
/// expensive blocks cluster.
std::vector<int> block_shares(std::size_t blocks, int shares);

/// The blocks of these shares.
std::vector<Rect> shared_blocks(const Shares& shares, const Rect& region);

}  // namespace rt
