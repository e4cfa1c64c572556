// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/image/encoding.h"
#include "host/image/picture.h"
#include "host/image/picture_format.h"

namespace rt {

/// Writes a picture in the format of its ending: .png (8 bits a channel, 1 to 4 channels), .exr
/// (32-bit float, zip, nothing lost), .pfm (32-bit float, 1 or 3 channels), or in what OpenImageIO
/// writes: .tif (32-bit float), .hdr (shared exponents), .jpg .webp .tga .bmp .ppm (8 bits).
/// The encoding concerns 8 bits only. A format that is given counts, not the ending. The file
/// appears whole or not at all (atomic_file.h), and the same arguments give the same bytes whenever
/// it is written: no time stamp, no program name.
///
/// Metadata goes to .png as text chunks and to .exr as string attributes, under its own names; the
/// other formats drop it. Each name must be "mirrorball:" and then 1 to 20 of [A-Za-z0-9_]. Texts
/// are UTF-8 without NUL; an empty one is left out.
///
/// Throws Error: usage for the ending, output when it cannot be written, bug for a picture
/// whose size is not its pixels' or a metadata name that is not as above.
void write_picture(const std::string& path, const Picture& picture, Encoding encoding,
                   std::span<const std::pair<std::string, std::string>> metadata = {},
                   std::optional<PictureFormat> format = {});

/// The bytes of the .png that write_picture would write. Throws Error as it does.
std::vector<std::byte> encode_png(const Picture& picture, Encoding encoding);

/// Refuses, before anything is computed, what write_picture would refuse after: Error(usage) for
/// the ending, Error(output) for a directory that is missing or not writable, or an image library
/// that is missing: the format's is loaded here.
void check_picture_path(const std::string& path, std::optional<PictureFormat> format = {});

/// Reads a picture of any format in picture_format.h, recognized by its first bytes; a name with
/// the ending of another format is refused. Integers become exactly v / 255 or v / 65535, floats
/// stay as they are; no color conversion, alpha as stored. Regular files only; sizes as in
/// check_picture_size, checked with the free memory before any is taken.
/// Throws Error(ExitCode::input), or limit when memory is short.
Picture read_picture(const std::string& path);

/// The same with the texts in the file, in its order. Other names than "mirrorball:..." are the
/// format's or the library's. Nothing for .pfm.
PictureFile read_picture_file(const std::string& path);

}  // namespace rt
