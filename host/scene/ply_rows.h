// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "host/scene/line_scanner.h"
#include "host/scene/ply_header.h"
#include "host/scene/ply_value.h"

namespace rt {

// Two value sources with the same interface, so that one reader serves text and binary. They note a
// missing value, and then return nothing.

/// Says "element 'face' 17" (rows count from 0, as indices do).
std::string ply_row_name(const PlyElement& element, std::uint64_t row);

/// Reads binary rows, in either byte order.
class BinaryRows {
   public:
    BinaryRows(std::string_view text, const PlyHeader& header, Mistakes& mistakes)
        : begin_(text.data()),
          at_(begin_ + header.data_offset),
          end_(begin_ + text.size()),
          swapped_((header.format == PlyFormat::little_endian) !=
                   (std::endian::native == std::endian::little)),
          mistakes_(mistakes) {}

    void start_row(const PlyElement& element, std::uint64_t row) {
        element_ = &element;
        row_ = row;
    }
    void end_row() {}

    std::optional<double> number(PlyType type) {
        if (!has(size_of(type))) return std::nullopt;
        return ply_number(take(type), type, swapped_);
    }

    std::optional<std::int64_t> integer(PlyType type) {
        if (!has(size_of(type))) return std::nullopt;
        return ply_whole(take(type), type, swapped_);
    }

    /// Skips this many values; returns whether they exist.
    bool skip(PlyType type, std::uint64_t count) {
        if (bytes_left() / size_of(type) < count) return has(bytes_left() + 1);
        at_ += count * size_of(type);
        return true;
    }

    std::uint64_t bytes_left() const { return static_cast<std::uint64_t>(end_ - at_); }
    std::string_view left() const { return {at_, static_cast<std::size_t>(end_ - at_)}; }
    /// Skips bytes that exist and were already read another way.
    void advance(std::size_t bytes) { at_ += bytes; }
    bool swapped() const { return swapped_; }
    /// Whether a row was truncated, which leaves nothing to read after it.
    bool lost() const { return lost_; }
    void note(std::string message) {
        mistakes_.add_in(ply_row_name(*element_, row_), offset(), std::move(message));
    }
    /// A note about data after the last row; empty if there is none.
    std::string leftover();

   private:
    std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }

    bool has(std::size_t bytes) {
        if (bytes <= bytes_left()) return true;
        note("the file ends before it does; save the model again");
        lost_ = true;
        return false;
    }

    const char* take(PlyType type) { return std::exchange(at_, at_ + size_of(type)); }

    const char *begin_, *at_, *end_;
    bool swapped_;
    bool lost_ = false;
    Mistakes& mistakes_;
    const PlyElement* element_ = nullptr;
    std::uint64_t row_ = 0;
};

/// Reads text rows, one per line.
class TextRows {
   public:
    TextRows(std::string_view text, const PlyHeader& header, Mistakes& mistakes)
        : scanner_(text, header.data_offset), mistakes_(mistakes) {}

    void start_row(const PlyElement& element, std::uint64_t row);
    void end_row();
    std::optional<double> number(PlyType type);
    std::optional<std::int64_t> integer(PlyType type);
    bool skip(PlyType type, std::uint64_t count);
    std::uint64_t bytes_left() const { return scanner_.bytes_left(); }
    bool lost() const { return lost_; }
    void note(std::string message) { mistakes_.add(scanner_.offset(), std::move(message)); }
    std::string leftover();

   private:
    bool has_word();

    LineScanner scanner_;
    Mistakes& mistakes_;
    const PlyElement* element_ = nullptr;
    std::uint64_t row_ = 0;
    bool lost_ = false;
    bool noted_ = false;  ///< something is wrong with the current row
};

}  // namespace rt
