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
    /// The minimum bytes per row: in a binary file, or as text.
    std::size_t least_bytes(PlyFormat format) const;
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

/// A value of a whole type.
inline std::int64_t ply_whole(const char* at, PlyType type, bool swapped) {
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
        case PlyType::float32:
        case PlyType::float64:
            break;
    }
    return ply_bytes<std::uint32_t>(at, swapped);
}

/// A value of any type.
inline double ply_number(const char* at, PlyType type, bool swapped) {
    if (type == PlyType::float32) return ply_bytes<float>(at, swapped);
    if (type == PlyType::float64) return ply_bytes<double>(at, swapped);
    return static_cast<double>(ply_whole(at, type, swapped));
}

// A fast parallel path for the rows of a binary file that all have the same length.

/// The bytes of an element's rows; empty if a list makes their length vary or they are truncated.
std::optional<std::string_view> fixed_rows(std::string_view data, const PlyElement& element);

/// Reads three properties, given by their places, of rows as returned by fixed_rows; returns
/// whether all numbers are within max_scene_number.
bool read_columns(std::string_view rows, const PlyElement& element,
                  const std::array<std::size_t, 3>& properties, bool swapped,
                  std::vector<glm::dvec3>& target, const ReadPace& pace);

struct PlyFaces {
    std::vector<Scene::Mesh::Face> faces;
    std::size_t bytes = 0;  ///< read from the data
};

/// Reads faces that are all triangles, or all quadrilaterals that pass parts_well, from the start
/// of `data`; a row must have one list. Nothing for all others: rows must then be read one by one.
std::optional<PlyFaces> read_face_block(std::string_view data, const PlyElement& element,
                                        bool swapped, const std::vector<glm::dvec3>& positions,
                                        const ReadPace& pace);

}  // namespace rt
