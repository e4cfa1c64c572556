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
inline bool is_whole(PlyType type) { return type < PlyType::float32; }

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;    ///< of the value, or of a list's items
    std::optional<PlyType> count_type;  ///< of a list's length; empty for a single value
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
    std::size_t offset = 0;  ///< of its line in the file

    const PlyProperty* find(std::string_view property) const;
    /// The minimum bytes per row: in a binary file, or as text.
    std::size_t least_bytes(PlyFormat format) const;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;
    std::size_t data_offset = 0;

    const PlyElement* find(std::string_view element) const;
};

/// Reads the header of a PLY file (Turk 1994), up to the line end after end_header. Throws all of
/// the header's mistakes at once.
PlyHeader parse_ply_header(Mistakes& mistakes);

}  // namespace rt
