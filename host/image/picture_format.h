// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace rt {

/// The formats pictures are read and written in.
enum class PictureFormat { png, exr, pfm, tiff, jpeg, webp, hdr, tga, bmp, pnm, dpx };

/// What is known of a format.
struct PictureFormatFacts {
    PictureFormat format;
    std::string_view name;    ///< "PNG"
    const char* module_name;  ///< OpenImageIO's: "png", "openexr", "targa"
    std::array<std::string_view, 3> extensions;
    bool stores_floats = false;  ///< exactly, but for .hdr's 8-bit mantissas; else 8-bit integers
    int longest_side = std::numeric_limits<int>::max();  ///< in pixels
};
const PictureFormatFacts& facts_of(PictureFormat format);

/// The format of a file name's extension, case-insensitive; empty if unknown.
std::optional<PictureFormat> known_picture_format(const std::string& path);

/// The same; throws Error(ExitCode::usage) with the list of formats if unknown.
PictureFormat picture_format_of_name(const std::string& path);

}  // namespace rt
