// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/line_scanner.h"
#include "host/scene/mistakes.h"
#include "host/scene/scene.h"

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

/// Reads a number from bytes, byte-swapped if `swapped`.
template <typename T>
T ply_bytes(const char* at, bool swapped) {
    std::array<unsigned char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), at, sizeof(T));
    if (swapped) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
}

inline double ply_number(const char* at, PlyType type, bool swapped) {
    switch (type) {
        case PlyType::int8:
            return static_cast<std::int8_t>(*at);
        case PlyType::uint8:
            return static_cast<std::uint8_t>(*at);
        case PlyType::int16:
            return ply_bytes<std::int16_t>(at, swapped);
        case PlyType::uint16:
            return ply_bytes<std::uint16_t>(at, swapped);
        case PlyType::int32:
            return ply_bytes<std::int32_t>(at, swapped);
        case PlyType::uint32:
            return ply_bytes<std::uint32_t>(at, swapped);
        case PlyType::float32:
            return ply_bytes<float>(at, swapped);
        case PlyType::float64:
            break;
    }
    return ply_bytes<double>(at, swapped);
}

// A fast parallel path for the rows of a binary file that all have the same length.

/// Reads three properties, given by their places, of an element's rows, which have no lists;
/// returns whether all numbers are within max_scene_number.
bool read_columns(const char* rows, const PlyElement& element,
                  const std::array<std::size_t, 3>& properties, bool swapped,
                  std::vector<glm::dvec3>& target, const ReadPace& pace);

/// Appends faces that are all triangles, or all quadrilaterals that pass parts_well, from the start
/// of `data`, and returns their bytes; a row must have one list. Returns 0 for all others: rows
/// must then be read one by one.
std::size_t read_face_block(std::string_view data, const PlyElement& element, bool swapped,
                            const std::vector<glm::dvec3>& positions,
                            std::vector<Scene::Mesh::Face>& faces, const ReadPace& pace);

}  // namespace rt
