// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <istream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/image/encoding.h"
#include "host/image/picture.h"

namespace rt {

struct InputFile {
    std::ifstream stream;
    std::uintmax_t size = 0;  // in bytes
};

/// Throws Error(ExitCode::input) "path: reason; advice".
[[noreturn]] void refuse_picture(const std::string& path, const std::string& reason,
                                 const std::string& advice);

/// The same for pixels that cannot be decoded.
[[noreturn]] void refuse_damaged(const std::string& path, const std::string& reason);

/// Opens a regular file only (a pipe could block forever, a device never end).
/// Throws Error(ExitCode::input) "path: cannot read: reason; what to do".
InputFile open_input_file(const std::string& path);

/// Refuses sizes that are not a picture (empty, more than 64 channels) or too large: at most 65536
/// x 65536, 2^28 pixels, 2^30 values. Throws Error(ExitCode::input).
void check_picture_size(const std::string& path, int width, int height, int channels);

/// Throws Error(ExitCode::limit) when a picture of this size does not fit into free memory.
void check_picture_memory(const std::string& path, int width, int height, int channels);

// PNG and PFM, which need no module.

/// The picture as a PNG file of 8 bits a channel, 1 or 3 channels; the metadata as text chunks
/// (texts are UTF-8). Throws Error(ExitCode::output) naming `path`.
std::vector<std::byte> encode_png_file(
    const std::string& path, const Picture& picture, Encoding encoding,
    std::span<const std::pair<std::string, std::string>> metadata);

/// Reads a PNG file: palettes and fewer than 8 bits become 8 bits, a transparent color becomes
/// alpha. Without pixels, it reads what is in front of them. Throws Error(ExitCode::input).
PictureFile read_png(const std::string& path, std::istream& stream, bool with_pixels);

/// Writes the picture as a Portable Float Map: "PF" (3 channels) or "Pf" (1 channel), little-endian
/// 32-bit floats, bottom row first; every bit of every float is kept. The format cannot hold
/// metadata. Needs almost no memory. Other channel counts throw Error(ExitCode::output).
void write_pfm(const std::string& path, const Picture& picture);

/// Reads a Portable Float Map of either byte order. The magnitude of the scale in its header is
/// a unit of measure and does not change the values. Throws Error(ExitCode::input).
Picture read_pfm(const std::string& path, InputFile file, bool with_pixels);

}  // namespace rt
