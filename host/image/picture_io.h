// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "host/image/encoding.h"
#include "host/image/picture.h"

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

/// Writes a picture in the format of its extension: .png (8 bits a channel, 1 or 3 channels), .exr
/// (32-bit float, zip, lossless), .pfm (32-bit float, 1 or 3 channels), or what OpenImageIO writes:
/// .tif (32-bit float), .hdr (shared exponents), .jpg .webp .tga .bmp .ppm .dpx (8 bits). The
/// encoding applies to 8 bits only. A given format overrides the extension. The file appears whole
/// or not at all (output_file.h), and the same arguments always give the same bytes: no time stamp,
/// no program name.
///
/// Metadata goes to .png as text chunks and to .exr as string attributes, under its own names; the
/// other formats drop it. Each name is "mirrorball:" and then 1 to 20 of [A-Za-z0-9_]. Texts
/// are UTF-8 without NUL; an empty one is left out.
///
/// Throws Error: usage for the extension, output when it cannot be written, limit when the format
/// cannot hold its size.
void write_picture(const std::string& path, const Picture& picture, Encoding encoding,
                   std::span<const std::pair<std::string, std::string>> metadata = {},
                   std::optional<PictureFormat> format = {});

/// Refuses, before anything is computed, what write_picture would refuse: Error(usage) for the
/// extension, Error(output) for a directory that is missing or not writable, or a missing image
/// library: the format's is loaded here.
void check_picture_path(const std::string& path, std::optional<PictureFormat> format = {});

/// Throws Error(ExitCode::limit) for a picture larger than its format can hold.
void check_picture_fits(const std::string& path, int width, int height,
                        std::optional<PictureFormat> format = {});

/// Reads a picture in the format of its extension, any of PictureFormat. Integers become exactly
/// v / 255 or v / 65535 (of 16-bit PNM, OpenImageIO's nearly), floats are unchanged; no color
/// conversion, alpha as stored. Regular files only; checks the size (check_picture_size) and free
/// memory before allocating. Throws Error(ExitCode::input), or limit when memory is short.
Picture read_picture(const std::string& path);

/// The same with the file's metadata, in file order. Names other than "mirrorball:..." come from
/// the format or the library. .pfm has none.
PictureFile read_picture_file(const std::string& path);

/// The same but for the pixels: size, channels, and what metadata precede them.
PictureFile read_picture_header(const std::string& path);

}  // namespace rt
