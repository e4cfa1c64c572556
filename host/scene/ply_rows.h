// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "host/scene/line_scanner.h"
#include "host/scene/ply_header.h"

namespace rt {

// Two sources of values with the same functions, so that one reader serves text and binary. A
// value that is not there is noted, and then nothing is returned.

/// Says "element 'face' 17" (rows count from 0, as indices do).
std::string ply_row_name(const PlyElement& element, std::uint64_t row);

/// Rows of bytes, in either order.
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
        switch (type) {
            case PlyType::float32:
                return std::bit_cast<float>(take<std::uint32_t>());
            case PlyType::float64:
                return std::bit_cast<double>(take<std::uint64_t>());
            default:
                return static_cast<double>(take_whole(type));
        }
    }

    std::optional<std::int64_t> integer(PlyType type) {
        if (!has(size_of(type))) return std::nullopt;
        return take_whole(type);
    }

    /// Skips this many values; whether they are there.
    bool skip(PlyType type, std::uint64_t count) {
        if (bytes_left() / size_of(type) < count) return has(bytes_left() + 1);
        at_ += count * size_of(type);
        return true;
    }

    std::uint64_t bytes_left() const { return static_cast<std::uint64_t>(end_ - at_); }
    /// A row that is cut short leaves nothing to read after it.
    bool lost() const { return lost_; }
    void note(std::string message) {
        mistakes_.add_in(ply_row_name(*element_, row_), offset(), std::move(message));
    }
    /// What stands after the last row, as a note for the user; empty when all is well.
    std::string leftover();

   private:
    std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }

    bool has(std::size_t bytes) {
        if (bytes <= bytes_left()) return true;
        note("the file ends before it does; save the model again");
        lost_ = true;
        return false;
    }

    template <typename U>
    U take() {
        std::array<unsigned char, sizeof(U)> bytes;
        std::memcpy(bytes.data(), at_, sizeof(U));
        at_ += sizeof(U);
        if (swapped_) std::reverse(bytes.begin(), bytes.end());
        return std::bit_cast<U>(bytes);
    }

    /// Of a whole type.
    std::int64_t take_whole(PlyType type) {
        switch (type) {
            case PlyType::int8:
                return static_cast<std::int8_t>(take<std::uint8_t>());
            case PlyType::uint8:
                return take<std::uint8_t>();
            case PlyType::int16:
                return static_cast<std::int16_t>(take<std::uint16_t>());
            case PlyType::uint16:
                return take<std::uint16_t>();
            case PlyType::int32:
                return static_cast<std::int32_t>(take<std::uint32_t>());
            case PlyType::uint32:
            case PlyType::float32:
            case PlyType::float64:
                break;
        }
        return take<std::uint32_t>();
    }

    const char *begin_, *at_, *end_;
    bool swapped_;
    bool lost_ = false;
    Mistakes& mistakes_;
    const PlyElement* element_ = nullptr;
    std::uint64_t row_ = 0;
};

/// Rows of text, a line each.
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
