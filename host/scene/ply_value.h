// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "host/scene/ply_header.h"

namespace rt {

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

}  // namespace rt
