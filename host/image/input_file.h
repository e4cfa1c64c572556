// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

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

/// Refuses a file whose header promises more pixel bytes than it could hold at its format's best
/// compression ratio, `best_ratio` to 1. Throws Error(ExitCode::input).
void check_stored_size(const std::string& path, std::uintmax_t pixel_bytes,
                       std::uintmax_t best_ratio, std::uintmax_t file_size);

/// Throws Error(ExitCode::limit) when a picture of this size does not fit into free memory.
void check_picture_memory(const std::string& path, int width, int height, int channels);

}  // namespace rt
