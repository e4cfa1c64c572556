// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/render/rect.h"

namespace rt {

/// Some of the shares that a picture is cut into: those of one machine. A picture of one share is
/// whole.
struct Shares {
    static constexpr int most = 100000;

    std::vector<int> numbers{0};  ///< ascending, from 0 to of - 1
    int of = 1;

    bool operator==(const Shares&) const = default;
};

/// "7/64" or "7,9,20-25/64"; empty when the text is anything else.
std::optional<Shares> parse_shares(std::string_view text);

/// The text that parse_shares reads back.
std::string to_string(const Shares& shares);

/// The blocks that the shares of a region are made of, row by row, about a thousand of them:
/// squares of 16, 32, 64, 128 or 256 pixels, smaller at the edges.
std::vector<Rect> share_blocks(const Rect& region);

/// The share that each of so many blocks belongs to: equally many to each, spread at random (always
/// the same way), since what costs much lies together.
std::vector<int> block_shares(std::size_t blocks, int shares);

/// What the shares need of a film, a number a pixel: 0 nothing; d + 1 a pixel from which it takes
/// refine_passes - d steps to one of their own, which has refine_passes + 1. Where nothing is
/// refined all but their own are 0.
std::vector<std::uint8_t> share_needs(const Shares& shares, const Rect& region, const Rect& film,
                                      bool refines);

/// Cuts each cell, which lies in the film, into the largest rectangles, more or less, of those of
/// its pixels that are not 0 in `wanted`.
std::vector<Rect> wanted_tiles(const std::vector<Rect>& cells,
                               const std::vector<std::uint8_t>& wanted, const Rect& film);

}  // namespace rt
