// SPDX-License-Identifier: Apache-2.0
#include "host/journal/shares.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "host/base/text.h"
#include "host/render/tile_queue.h"

namespace rt {

namespace {

constexpr double blocks_of_a_picture = 1000;
constexpr int smallest_block = 16, largest_block = 256;

/// Appends "7" or "20-25" to `numbers`; false when it is neither or not below `of`.
bool parse_range(std::string_view text, int of, std::vector<int>& numbers) {
    const std::size_t dash = text.find('-');
    const auto first = parse_number<int>(text.substr(0, dash));
    const auto last = dash == text.npos ? first : parse_number<int>(text.substr(dash + 1));
    if (!first || !last || *last < *first || *last >= of) return false;
    for (int number = *first; number <= *last; ++number) numbers.push_back(number);
    return true;
}

/// Hashes a number (the finalizer of SplitMix64; Steele, Lea and Flood 2014).
std::uint64_t mixed(std::uint64_t number) {
    number += 0x9e3779b97f4a7c15u;
    number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9u;
    number = (number ^ (number >> 27)) * 0x94d049bb133111ebu;
    return number ^ (number >> 31);
}

}  // namespace

std::optional<Shares> parse_shares(std::string_view text) {
    const std::size_t slash = text.find('/');
    if (slash == text.npos) return {};
    const auto of = parse_number<int>(text.substr(slash + 1));
    if (!of || *of < 1 || *of > Shares::most) return {};
    Shares shares{{}, *of};
    std::string_view list = text.substr(0, slash);
    for (;;) {
        const std::size_t comma = list.find(',');
        if (!parse_range(list.substr(0, comma), *of, shares.numbers)) return {};
        if (comma == list.npos) break;
        list.remove_prefix(comma + 1);
        if (shares.numbers.size() > static_cast<std::size_t>(Shares::most)) return {};
    }
    std::sort(shares.numbers.begin(), shares.numbers.end());
    const auto end = std::unique(shares.numbers.begin(), shares.numbers.end());
    shares.numbers.erase(end, shares.numbers.end());
    return shares;
}

std::string to_string(const Shares& shares) {
    std::string text;
    for (std::size_t i = 0; i < shares.numbers.size(); ++i) {
        const int first = shares.numbers[i];
        while (i + 1 < shares.numbers.size() && shares.numbers[i + 1] == shares.numbers[i] + 1) ++i;
        const int last = shares.numbers[i];
        text += (text.empty() ? "" : ",") + std::to_string(first);
        if (last > first) text += (last == first + 1 ? "," : "-") + std::to_string(last);
    }
    return text + "/" + std::to_string(shares.of);
}

std::vector<Rect> share_blocks(const Rect& region) {
    const double side = std::sqrt(static_cast<double>(region.pixels()) / blocks_of_a_picture);
    const auto power = std::bit_ceil(static_cast<unsigned>(std::max(side, 1.0)));
    const int block = std::clamp(static_cast<int>(power), smallest_block, largest_block);
    return make_tiles(region, block, block);
}

std::vector<int> block_shares(std::size_t blocks, int shares) {
    std::vector<std::size_t> order(blocks);
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [](std::size_t a, std::size_t b) {
        return std::pair(mixed(a), a) < std::pair(mixed(b), b);
    });
    std::vector<int> share_of(blocks);
    for (std::size_t i = 0; i < blocks; ++i) {
        share_of[order[i]] = static_cast<int>(i % static_cast<std::size_t>(shares));
    }
    return share_of;
}

std::vector<std::uint8_t> shared_pixels(const Shares& shares, const Rect& region) {
    std::vector<std::uint8_t> shared(static_cast<std::size_t>(region.pixels()), 0);
    const std::vector<Rect> blocks = share_blocks(region);
    const std::vector<int> share_of = block_shares(blocks.size(), shares.of);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (!std::binary_search(shares.numbers.begin(), shares.numbers.end(), share_of[i])) {
            continue;
        }
        const Rect& block = blocks[i];
        for (int y = block.y; y < block.y + block.height; ++y) {
            std::fill_n(shared.begin() + static_cast<std::ptrdiff_t>(index_in(region, block.x, y)),
                        block.width, std::uint8_t{1});
        }
    }
    return shared;
}

std::vector<Rect> wanted_tiles(const std::vector<Rect>& cells,
                               const std::vector<std::uint8_t>& wanted, const Rect& region) {
    std::vector<Rect> tiles;
    for (const Rect& cell : cells) {
        const std::size_t first_of_cell = tiles.size();
        for (int y = cell.y; y < cell.y + cell.height; ++y) {
            const int end = cell.x + cell.width;
            for (int x = cell.x; x < end;) {
                if (wanted[index_in(region, x, y)] == 0) {
                    ++x;
                    continue;
                }
                const int first = x;
                while (x < end && wanted[index_in(region, x, y)] != 0) ++x;
                const auto above =
                    std::find_if(tiles.begin() + static_cast<std::ptrdiff_t>(first_of_cell),
                                 tiles.end(), [&](const Rect& tile) {
                                     return tile.x == first && tile.width == x - first &&
                                            tile.y + tile.height == y;
                                 });
                if (above == tiles.end()) {
                    tiles.push_back({first, y, x - first, 1});
                } else {
                    ++above->height;
                }
            }
        }
    }
    return tiles;
}

}  // namespace rt
