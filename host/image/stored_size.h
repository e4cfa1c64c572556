// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/image/input_file.h"
#include "host/image/picture_format.h"

// What OpenImageIO's readers do not check.
namespace rt {

/// Refuses a file too small for the values (pixels times channels) that its header promises, as
/// check_stored_size does, where the format limits its compression: WebP does not.
void check_stored_values(const std::string& path, PictureFormat format, std::uintmax_t values,
                         std::uintmax_t file_size);

/// Refuses a JPEG file that was cut short, whose missing pixels its reader makes up.
/// Throws Error(ExitCode::input).
void check_jpeg_end(const std::string& path, InputFile& file);

}  // namespace rt
