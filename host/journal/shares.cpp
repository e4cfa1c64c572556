// SPDX-License-Identifier: Apache-2.0
#include "host/journal/shares.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <set>
#include <span>
#include <utility>

#include "host/base/error.h"
#include "host/base/memory.h"
#include "host/base/text.h"
#include "host/image/built_in_formats.h"
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
    for (const std::string& range : split(text, ',')) {
        const std::size_t dash = range.find('-');
        const auto first = parse_number<int>(range.substr(0, dash));
        const auto last = dash == range.npos ? first : parse_number<int>(range.substr(dash + 1));
        if (!first || !last || *last < *first || *last > most) return {};
        for (int number = *first; number <= *last; ++number) numbers.insert(number);
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

namespace {

Shares shares_of(const JournalHeader& header) {
    const auto shares = parse_shares(header.shares);
    if (shares) return *shares;
    throw Error(ExitCode::input, "its header is damaged (shares); render it again");
}

/// Calls read(reader) with a part, and adds its name to errors.
template <typename Read>
void read_part(const std::string& path, const Read& read) {
    InputFile file = open_input_file(path);
    try {
        JournalReader reader(file.stream, file.size);
        read(reader);
    } catch (const DamagedJournal& error) {
        throw DamagedJournal(error.exit_code(), path + ": " + error.what());
    } catch (const Error& error) {
        if (error.exit_code() != ExitCode::input) throw;
        throw Error(ExitCode::input, path + ": " + error.what());
    }
}

void check_same_picture(const JournalHeader& header, const std::string& first_path,
                        const JournalHeader& first) {
    const bool is_same = header.key == first.key && header.picture == first.picture &&
                         header.inexact_devices == first.inexact_devices;
    if (is_same) return;
    const auto what = [&]() -> std::string {
        if (header.scene_hash != first.scene_hash) return "the scene differs";
        if (header.picture != first.picture) return "the settings differ";
        return "the version of mirrorball, or the device's rounding, differs";
    };
    throw Error(ExitCode::input,
                printable(fmt::format("is not a part of the same picture as {}: {} ({}, {}; "
                                      "{}, {})",
                                      first_path, what(), header.scene, to_string(header.picture),
                                      first.scene, to_string(first.picture))));
}

template <typename T>
class Merger {
   public:
    explicit Merger(const JournalHeader& header)
        : region_(header.picture.region),
          film_(region_.width, region_.height),
          owner_(static_cast<std::size_t>(region_.pixels()), -1) {}

    void add(const std::string& path, JournalReader& reader, std::vector<std::string>& notes) {
        parts_.push_back(fmt::format("{} ({})", path, printable(reader.header().writer)));
        while (const auto record = reader.next()) {
            for_each_row(*record, region_, [&](std::size_t at, std::span<const std::byte> row) {
                for (; !row.empty(); row = row.subspan(pixel_bytes)) take_pixel(at++, row.data());
            });
        }
        if (const auto damaged = reader.bytes() - reader.good_bytes(); damaged > 0) {
            notes.push_back(fmt::format("{}: ignored the last {}, which are damaged", path,
                                        counted(damaged, "byte")));
        }
    }

    MergedPicture result(const JournalHeader& header) {
        MergedPicture merged;
        merged.header = header;
        merged.missing_pixels =
            static_cast<std::size_t>(std::count(owner_.begin(), owner_.end(), -1));
        if (merged.missing_pixels > 0) merged.missing = missing(shares_of(header).of);
        merged.image_hash = hash_of(film_);
        merged.picture.width = film_.width;
        merged.picture.height = film_.height;
        merged.picture.pixels = as_floats(std::move(film_));
        return merged;
    }

   private:
    static constexpr std::size_t pixel_bytes = 3 * sizeof(T);

    /// Throws Error where another part's pixel differs.
    void take_pixel(std::size_t i, const std::byte* values) {
        const std::size_t part = parts_.size() - 1;
        if (owner_[i] < 0) {
            owner_[i] = static_cast<int>(part);
            std::memcpy(&film_.rgb[3 * i], values, pixel_bytes);
        } else if (std::memcmp(&film_.rgb[3 * i], values, pixel_bytes) != 0) {
            const auto width = static_cast<std::size_t>(region_.width);
            throw Error(ExitCode::different,
                        fmt::format("{} and {} differ at {},{}; one of the devices is wrong: "
                                    "render both shares again",
                                    parts_[static_cast<std::size_t>(owner_[i])], parts_[part],
                                    static_cast<std::size_t>(region_.x) + i % width,
                                    static_cast<std::size_t>(region_.y) + i / width));
        }
    }

    /// Which shares, out of `of`, have missing pixels.
    Shares missing(int of) const {
        std::set<int> numbers;
        const std::vector<Rect> blocks = share_blocks(region_);
        const std::vector<int> share_of = block_shares(blocks.size(), of);
        for (std::size_t b = 0; b < blocks.size(); ++b) {
            const Rect& block = blocks[b];
            for (int y = block.y; y < block.y + block.height; ++y) {
                const std::size_t first = index_in(region_, block.x, y);
                const std::span row(&owner_[first], static_cast<std::size_t>(block.width));
                if (std::ranges::count(row, -1) > 0) numbers.insert(share_of[b]);
            }
        }
        return {{numbers.begin(), numbers.end()}, of};
    }

    const Rect region_;
    Film<T> film_;
    std::vector<int> owner_;          ///< index of the part that each pixel came from; -1: none
    std::vector<std::string> parts_;  ///< "a.mbj (threads on HOST)"
};

template <typename T>
MergedPicture merge(const std::vector<std::string>& paths, const JournalHeader& first,
                    std::vector<std::string> notes) {
    check_memory(
        static_cast<std::uint64_t>(first.picture.region.pixels()) * (3 * sizeof(T) + sizeof(int)),
        "the merged film", "render parts with --crop");
    Merger<T> merger(first);
    for (const std::string& path : paths) {
        read_part(path, [&](JournalReader& reader) {
            check_same_picture(reader.header(), paths.front(), first);
            merger.add(path, reader, notes);
        });
    }
    MergedPicture merged = merger.result(first);
    merged.notes = std::move(notes);
    return merged;
}

}  // namespace

MergedPicture merge_journals(const std::vector<std::string>& parts) {
    std::vector<std::string> readable, notes;
    JournalHeader first;
    for (const std::string& path : parts) {
        try {
            read_part(path, [&](JournalReader& reader) {
                if (readable.empty()) first = reader.header();
                readable.push_back(path);
            });
        } catch (const DamagedJournal& error) {
            notes.emplace_back(error.what());
        }
    }
    if (readable.empty()) throw Error(ExitCode::input, notes.front());
    check_picture_size(readable.front(), first.picture.region.width, first.picture.region.height,
                       3);
    return first.is_double() ? merge<double>(readable, first, std::move(notes))
                             : merge<float>(readable, first, std::move(notes));
}

}  // namespace rt
