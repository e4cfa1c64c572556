// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/image/encoding.h"
#include "host/image/picture.h"

namespace rt {

/// The picture as a PNG file of 8 bits a channel, 1 to 4 channels; the metadata as text chunks
/// (texts are UTF-8). Throws Error(ExitCode::output) naming `path`.
std::vector<std::byte> encode_png_file(
    const std::string& path, const Picture& picture, Encoding encoding,
    std::span<const std::pair<std::string, std::string>> metadata);

/// Reads a PNG file of `size` bytes: palettes and fewer than 8 bits become 8 bits, a transparent
/// color becomes alpha. Throws Error(ExitCode::input).
PictureFile read_png(const std::string& path, std::istream& stream, std::uintmax_t size);

}  // namespace rt
