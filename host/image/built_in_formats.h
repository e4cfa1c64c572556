// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <istream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/image/encoding.h"
#include "host/image/input_file.h"
#include "host/image/picture.h"

// PNG and PFM, which need no module.
namespace rt {

/// The picture as a PNG file of 8 bits a channel, 1 to 4 channels; the metadata as text chunks
/// (texts are UTF-8). Throws Error(ExitCode::output) naming `path`.
std::vector<std::byte> encode_png_file(
    const std::string& path, const Picture& picture, Encoding encoding,
    std::span<const std::pair<std::string, std::string>> metadata);

/// Reads a PNG file of `size` bytes: palettes and fewer than 8 bits become 8 bits, a transparent
/// color becomes alpha. Without pixels, it reads what is in front of them. Throws
/// Error(ExitCode::input).
PictureFile read_png(const std::string& path, std::istream& stream, std::uintmax_t size,
                     bool with_pixels);

/// Writes the picture as a Portable Float Map: "PF" (3 channels) or "Pf" (1 channel), little-endian
/// 32-bit floats, bottom row first; every bit of every float is kept. The format cannot hold
/// metadata. Needs almost no memory. Other channel counts throw Error(ExitCode::output).
void write_pfm(const std::string& path, const Picture& picture);

/// Reads a Portable Float Map of either byte order. The magnitude of the scale in its header is
/// a unit of measure and does not change the values. Throws Error(ExitCode::input).
Picture read_pfm(const std::string& path, InputFile file, bool with_pixels);

}  // namespace rt
