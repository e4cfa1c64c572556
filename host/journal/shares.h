// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/image/picture.h"
#include "host/journal/journal_format.h"

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

/// A picture merged from its parts.
struct MergedPicture {
    JournalHeader header;  ///< of the first part
    Picture picture;       ///< black where a part is missing
    std::uint64_t image_hash = 0;
    std::size_t missing_pixels = 0;
    std::optional<Shares> missing;   ///< the shares to render again, numbered as in the first part
    std::vector<std::string> notes;  ///< about incomplete parts
};

/// Merges parts in any order. Pixels present in several parts must be equal. Those without a
/// complete header are ignored, with a note. Throws Error: input for a part that is no journal or
/// belongs to another picture than the first; different, with files, hosts and devices, for the
/// first pixel that differs; limit.
MergedPicture merge_journals(const std::vector<std::string>& parts);

}  // namespace rt
