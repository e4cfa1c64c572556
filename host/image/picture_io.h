// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/image/encoding.h"
#include "host/image/picture.h"

namespace rt {

/// Writes a picture in the format of its extension: .png (8 bits a channel, 1 to 4 channels),
/// .exr (32-bit float, zip, nothing lost), .pfm (32-bit float, 1 or 3 channels).
/// The encoding concerns .png only. The file appears whole or not at all (atomic_file.h), and the
/// same arguments give the same bytes whenever it is written: no time stamp, no program name.
///
/// Metadata goes to .png as text chunks and to .exr as string attributes, under its own names;
/// .pfm has no place for it and drops it. OpenImageIO renames or swallows names that mean
/// something to it ("Description", "DateTime", ...), so each must be "mirrorball:" and then 1 to
/// 20 of [A-Za-z0-9_], which both formats keep as it is. Texts are UTF-8 without NUL; an empty one
/// is left out.
///
/// Throws Error: usage for the extension, output when it cannot be written, bug for a picture
/// whose size is not its pixels' or a metadata name that would not survive.
void write_picture(const std::string& path, const Picture& picture, Encoding encoding,
                   std::span<const std::pair<std::string, std::string>> metadata = {});

/// The bytes of the .png that write_picture would write. Throws Error as it does.
std::vector<std::byte> encode_png(const Picture& picture, Encoding encoding);

/// Refuses, before anything is computed, what write_picture would refuse after: Error(usage) for
/// the extension, Error(output) for a directory that is missing or not writable.
void check_picture_path(const std::string& path);

/// Reads a picture of any format that picture_format_of_bytes knows (PNG, EXR, PFM, JPEG, TIFF,
/// HDR, PNM), told by its first bytes whatever its name. Integers become exactly v / 255 or
/// v / 65535, floats stay as they are; no colour conversion, alpha as stored. Regular files only;
/// sizes as in check_picture_size. Throws Error(ExitCode::input), or limit when memory runs out.
Picture read_picture(const std::string& path);

/// The texts in the file without its pixels, in the order OpenImageIO lists them (.exr: by name).
/// Other names than "mirrorball:..." are OpenImageIO's: "oiio:ColorSpace", "compression", ...
/// Nothing for .pfm. Throws Error(ExitCode::input).
PictureMetadata read_picture_metadata(const std::string& path);

}  // namespace rt
