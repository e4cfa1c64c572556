// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <istream>

namespace rt::module {

struct ExrSize {
    int width = 0, height = 0, channels = 0;
};

/// Reads the headers of an OpenEXR file on its own and throws std::runtime_error for what would
/// make the library take memory without end: sizes that the file is too small for, blocks or
/// tiles much larger than the picture. Returns the size of the first part.
ExrSize check_exr_headers(std::istream& stream, std::uint64_t file_size);

}  // namespace rt::module
