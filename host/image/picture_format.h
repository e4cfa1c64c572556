// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rt {

/// The formats pictures are read and written in.
enum class PictureFormat { png, exr, pfm, tiff, jpeg, webp, hdr, tga, bmp, pnm, dpx };

/// "PNG", "EXR", ...
std::string_view to_string(PictureFormat format);

/// OpenImageIO's name of the format: "png", "openexr", "targa", ...
const char* module_name(PictureFormat format);

/// Whether it holds floats: .exr, .pfm and .tif exactly, .hdr with 8-bit mantissas. The others
/// hold 8-bit integers.
bool stores_floats(PictureFormat format);

/// The most pixels that a side may have, as far as the format or its library limits it.
int longest_side(PictureFormat format);

/// The most values that a byte of a file can hold; 0: no limit. Generous where it is not exact.
std::uintmax_t values_per_byte(PictureFormat format);

/// Whether reading and writing it takes a module (picture_module.h).
bool needs_module(PictureFormat format);

/// The format of a file name's extension, case-insensitive; empty if unknown.
std::optional<PictureFormat> known_picture_format(const std::string& path);

/// The same; throws Error(ExitCode::usage) with the list of formats if unknown.
PictureFormat picture_format_of_name(const std::string& path);

/// The format that a file's first 16 bytes identify; empty if they do not, as in TGA.
std::optional<PictureFormat> picture_format_of_bytes(std::string_view first_bytes);

}  // namespace rt
