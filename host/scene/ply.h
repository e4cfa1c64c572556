// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/mistakes.h"

namespace rt {

enum class PlyFormat { ascii, little_endian, big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr std::size_t size_of(PlyType type) {
    constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

constexpr bool is_whole(PlyType type) { return type < PlyType::float32; }

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;    ///< of the value, or of a list's items
    std::optional<PlyType> count_type;  ///< of a list's length; empty for a single value

    bool is_list() const { return count_type.has_value(); }
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
    std::size_t offset = 0;  ///< of its line in the file

    /// The place of the first property of this name, or of the list of a face's or strip's corners;
    /// properties.size() if there is none.
    std::size_t find(std::string_view property) const;
    std::size_t find_corners() const;
    std::size_t list_count() const;

    /// Where a property starts in a binary row whose lists have so many items.
    std::size_t offset_of(std::size_t property, std::size_t items) const;
    /// The bytes of such a row.
    std::size_t row_bytes(std::size_t items) const { return offset_of(properties.size(), items); }
};

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;
    std::size_t data_offset = 0;
};

/// Reads the header of a PLY file (Turk 1994), up to the line end after end_header, and checks that
/// it declares a mesh. Throws all of the header's mistakes at once.
PlyHeader parse_ply_header(Mistakes& mistakes);

}  // namespace rt
