// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "host/base/error.h"
#include "host/image/picture.h"
#include "host/image/picture_io.h"

namespace rt {

struct EncodeRequest {
    const char* format;  ///< OpenImageIO's name, such as "jpeg"
    const Picture& picture;
    std::span<const std::uint8_t> bytes;  ///< its pixels as 8 bits; empty: store the floats
    const char* color_space;              ///< declared in the file, by OpenImageIO's name, or null
    std::span<const PictureMetadata::value_type> metadata;  ///< empty texts are left out
};

/// Called with width, height and channels before memory is taken for them; throws to refuse them.
/// Returns whether the pixels are to be read.
using CheckSize = std::function<bool(int, int, int)>;

/// What a picture module does: libmirrorball_exr.so, which links OpenEXR, or libmirrorball_oiio.so,
/// which links OpenImageIO. Program and modules are built together and never unloaded, so C++ types
/// and exceptions cross. Both functions throw std::exception with the library's words.
struct PictureModule {
    /// Raised whenever these types or Picture change; the program refuses another version.
    static constexpr std::uint32_t current_version = 5;

    std::uint32_t version;
    std::vector<std::byte> (*encode)(const EncodeRequest& request);
    PictureFile (*decode)(const std::string& path, const char* format, const CheckSize& check);
};

/// The module that reads and writes the format, loaded on the first call: OpenEXR's takes a
/// millisecond or two, OpenImageIO's, with 260 libraries, 150 and more. Not for PNG and PFM, which
/// need none. The first caller loads it; others wait. Throws Error(failure) naming the missing
/// file.
const PictureModule& picture_module(PictureFormat format, ExitCode failure);

}  // namespace rt
