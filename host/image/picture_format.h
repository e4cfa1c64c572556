// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace rt {

/// The formats pictures are read and written in.
enum class PictureFormat { png, exr, pfm, tiff, jpeg, webp, hdr, tga, bmp, pnm };

/// "PNG", "EXR", ...
std::string_view to_string(PictureFormat format);

/// OpenImageIO's name of the format: "png", "openexr", "targa", ...
const char* module_name(PictureFormat format);

/// Whether it holds floats: .exr and .pfm every bit, .tif too, .hdr 8 bits of each. The others
/// hold 8-bit integers.
bool stores_floats(PictureFormat format);

/// Whether reading and writing it takes a module (module_loader.h).
bool needs_module(PictureFormat format);

/// The format the ending of a name stands for, in upper or lower case; nothing for other names.
std::optional<PictureFormat> known_picture_format(const std::string& path);

/// The same; other names throw Error(ExitCode::usage) with the list.
PictureFormat picture_format_of_name(const std::string& path);

/// What the first 16 bytes of a file say it is; nothing where they do not tell, as in TGA.
std::optional<PictureFormat> picture_format_of_bytes(std::string_view first_bytes);

}  // namespace rt
