// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <istream>

namespace rt {

struct ExrSize {
    int width = 0, height = 0, channels = 0;
};

/// Parses the headers of an OpenEXR file itself and throws std::runtime_error for anything that
/// would make the library allocate without bound: sizes that the file is too small for, or blocks
/// or tiles much larger than the picture. Returns the size of the first part.
ExrSize check_exr_headers(std::istream& stream, std::uint64_t file_size);

}  // namespace rt
