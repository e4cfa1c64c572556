// SPDX-License-Identifier: Apache-2.0
#include "host/scene/text_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "host/error.h"

namespace rt {
namespace {

namespace fs = std::filesystem;

void require_regular(const std::string& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    const auto refuse = [&](const std::string& why) {
        throw Error(ExitCode::input, path + ": " + why);
    };
    if (status.type() == fs::file_type::not_found) refuse("no such file; check the path");
    if (error) refuse(fmt::format("cannot be reached ({}); check the path", error.message()));
    if (fs::is_directory(status)) refuse("is a directory; name a scene file in it");
    if (!fs::is_regular_file(status)) {
        refuse("is not a regular file; save the scene to a file first");
    }
}

[[noreturn]] void refuse_size(const std::string& path, std::size_t max_bytes) {
    throw Error(ExitCode::limit,
                fmt::format("{}: the file is larger than {} MiB; split or shrink the scene", path,
                            max_bytes >> 20));
}

}  // namespace

std::string read_text_file(const std::string& path, std::size_t max_bytes) {
    require_regular(path);
    std::error_code unknown;  // the size is a hint only: files in /proc say 0
    const std::uintmax_t hint = fs::file_size(path, unknown);
    if (!unknown && hint > max_bytes) refuse_size(path, max_bytes);
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    const auto refuse = [&] {
        const std::string reason = errno != 0 ? std::strerror(errno) : "read error";
        throw Error(ExitCode::input,
                    fmt::format("{}: cannot be read ({}); check its permissions", path, reason));
    };
    if (!file) refuse();
    std::string text;
    constexpr std::size_t chunk = std::size_t{1} << 20;
    if (!unknown) text.reserve(static_cast<std::size_t>(hint) + chunk);
    std::size_t size = 0;
    while (file && size <= max_bytes) {
        text.resize(size + chunk);
        file.read(text.data() + size, chunk);
        size += static_cast<std::size_t>(file.gcount());
    }
    if (file.bad()) refuse();
    if (size > max_bytes) refuse_size(path, max_bytes);
    text.resize(size);
    return text;
}

}  // namespace rt
