// SPDX-License-Identifier: Apache-2.0
#include "host/image/input_file.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <system_error>

#include "host/base/error.h"
#include "host/base/memory.h"

namespace rt {

void refuse_picture(const std::string& path, const std::string& reason, const std::string& advice) {
    throw Error(ExitCode::input, path + ": " + reason + "; " + advice);
}

void refuse_damaged(const std::string& path, const std::string& reason) {
    refuse_picture(path, "cannot read the picture: " + reason, "it may be damaged: save it again");
}

InputFile open_input_file(const std::string& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) {
        refuse_picture(path, "cannot read: " + std::generic_category().message(errno),
                       "check the path");
    }
    if (S_ISDIR(status.st_mode)) refuse_picture(path, "is a directory", "name a picture file");
    if (!S_ISREG(status.st_mode))
        refuse_picture(path, "is not a regular file", "copy it to one first");
    errno = 0;
    InputFile file{std::ifstream(path, std::ios::binary),
                   static_cast<std::uintmax_t>(status.st_size)};
    if (!file.stream) {
        refuse_picture(path, "cannot read: " + std::generic_category().message(errno),
                       "check its permissions");
    }
    return file;
}

void check_picture_size(const std::string& path, int width, int height, int channels) {
    constexpr int largest_side = 65536;
    constexpr std::int64_t most_pixels = std::int64_t{1} << 28;
    constexpr std::int64_t most_values = std::int64_t{1} << 30;
    const std::string size = fmt::format("{}x{} pixels of {} channels", width, height, channels);
    if (width < 1 || height < 1 || channels < 1)
        refuse_picture(path, "has " + size, "save it again");
    const std::int64_t pixels = std::int64_t{width} * height;
    if (width > largest_side || height > largest_side || pixels > most_pixels || channels > 64 ||
        pixels * channels > most_values) {
        refuse_picture(
            path, "has " + size,
            "scale it down to at most 65536 pixels per side, 2^28 pixels and 2^30 values");
    }
}

void check_stored_size(const std::string& path, std::uintmax_t pixel_bytes,
                       std::uintmax_t best_ratio, std::uintmax_t file_size) {
    if (pixel_bytes / best_ratio <= file_size) return;
    refuse_picture(
        path,
        fmt::format("its {} bytes cannot hold the {} bytes of pixels that its header declares",
                    file_size, pixel_bytes),
        "it may be truncated: save it again");
}

void check_picture_memory(const std::string& path, int width, int height, int channels) {
    const std::uint64_t values =
        std::uint64_t(width) * std::uint64_t(height) * std::uint64_t(channels);
    check_memory(values * sizeof(float), path + ": its pixels as floats", "scale it down first");
}

}  // namespace rt
