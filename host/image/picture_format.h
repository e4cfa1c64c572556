// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace rt {

/// The formats pictures are written in.
enum class PictureFormat { png, exr, pfm };

/// The format an extension asks for, in upper or lower case; any other extension throws
/// Error(ExitCode::usage) with the list.
PictureFormat picture_format_of_name(const std::string& path);

/// Whether writing the format takes the image library.
bool needs_image_library(PictureFormat format);

/// What the first bytes of a file say it is, by OpenImageIO's name of the format, "pfm" for our
/// own; empty when it is nothing we read. The name of a file is not asked: OpenImageIO would try
/// all its 30 formats in turn, films from the network among them.
std::string_view picture_format_of_bytes(std::string_view first_bytes);

}  // namespace rt
