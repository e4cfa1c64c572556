// SPDX-License-Identifier: Apache-2.0
#include "host/journal/shares.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "host/base/text.h"
#include "host/render/tile_queue.h"

namespace rt {

namespace {

constexpr double blocks_of_a_picture = 1000;
constexpr int smallest_block = 16, largest_block = 256;

/// Hashes a number (the finalizer of SplitMix64; Steele, Lea and Flood 2014).
std::uint64_t mixed(std::uint64_t number) {
    number += 0x9e3779b97f4a7c15u;
    number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9u;
    number = (number ^ (number >> 27)) * 0x94d049bb133111ebu;
    return number ^ (number >> 31);
}

}  // namespace

std::optional<std::vector<int>> parse_ranges(std::string_view text, int most) {
    std::set<int> numbers;
    for (bool is_last = false; !is_last;) {
        const std::size_t comma = text.find(',');
        const std::string_view range = text.substr(0, comma);
        const std::size_t dash = range.find('-');
        const auto first = parse_number<int>(range.substr(0, dash));
        const auto last = dash == range.npos ? first : parse_number<int>(range.substr(dash + 1));
        if (!first || !last || *last < *first || *last > most) return {};
        for (int number = *first; number <= *last; ++number) numbers.insert(number);
        is_last = comma == text.npos;
        if (!is_last) text.remove_prefix(comma + 1);
    }
    return std::vector(numbers.begin(), numbers.end());
}

std::optional<Shares> parse_shares(std::string_view text) {
    const std::size_t slash = text.find('/');
    if (slash == text.npos) return {};
    const auto of = parse_number<int>(text.substr(slash + 1));
    if (!of || *of < 1 || *of > Shares::most) return {};
    const auto numbers = parse_ranges(text.substr(0, slash), *of - 1);
    return numbers ? std::optional(Shares{*numbers, *of}) : std::nullopt;
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

std::vector<Rect> shared_blocks(const Shares& shares, const Rect& region) {
    const std::vector<Rect> blocks = share_blocks(region);
    const std::vector<int> share_of = block_shares(blocks.size(), shares.of);
    std::vector<Rect> shared;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (std::ranges::binary_search(shares.numbers, share_of[i])) shared.push_back(blocks[i]);
    }
    return shared;
}

}  // namespace rt
