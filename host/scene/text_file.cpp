// SPDX-License-Identifier: Apache-2.0
#include "host/scene/text_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "host/base/error.h"
#include "host/base/lower.h"
#include "host/base/parallel.h"
#include "host/base/printable.h"

namespace rt {
namespace {

constexpr std::size_t piece = std::size_t{4} << 20;  // bytes that a thread reads at once

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
    throw Error(ExitCode::input, printable(path) + ": " + why);
}

[[noreturn]] void refuse_read(const std::string& path, int reason) {
    refuse(path, fmt::format("cannot be read ({}); check its permissions", std::strerror(reason)));
}

[[noreturn]] void refuse_open(const std::string& path, int reason) {
    if (reason == ENOENT) refuse(path, "no such file; check the path");
    if (reason == EACCES || reason == EPERM) refuse_read(path, reason);
    if (reason == ENXIO) refuse(path, "is not a regular file; save the scene to a file first");
    refuse(path, fmt::format("cannot be opened ({}); check the path", std::strerror(reason)));
}

/// Reads up to `size` bytes at an offset; fewer where the file ends before.
std::size_t read_at(const FileDescriptor& file, const std::string& path, char* target,
                    std::size_t size, std::size_t offset) {
    std::size_t done = 0;
    while (done < size) {
        const ssize_t got =
            pread(file.number(), target + done, size - done, static_cast<off_t>(offset + done));
        if (got == 0) break;
        if (got < 0 && errno != EINTR) refuse_read(path, errno);
        if (got > 0) done += static_cast<std::size_t>(got);
    }
    return done;
}

/// Reads a file whose size the system does not report, as in /proc.
FileText read_unsized(const FileDescriptor& file, const std::string& path, std::size_t max_bytes) {
    std::vector<char> text;
    std::size_t size = 0;
    do {
        text.resize(size + piece);
        size += read_at(file, path, text.data() + size, piece, size);
        require_size(path, size, max_bytes);
    } while (size == text.size());
    auto bytes = std::make_unique_for_overwrite<char[]>(size);
    std::copy_n(text.begin(), size, bytes.get());
    return {std::move(bytes), size};
}

struct Foreign {
    std::string_view start, message;
};

constexpr std::string_view utf16 = "is UTF-16 text; save it as UTF-8";

/// Letter case is ignored.
constexpr Foreign foreign_starts[] = {
    {"version https://git-lfs", "is a Git LFS pointer, not the file itself; run 'git lfs pull'"},
    {"<", "is a web page or XML; download the file itself, or export another format"},
    {"\x1f\x8b", "is compressed; unpack it with gunzip"},
    {"PK\x03\x04", "is a ZIP archive; unpack it with unzip"},
    {"BZh", "is compressed; unpack it with bunzip2"},
    {"\xfd\x37zXZ", "is compressed; unpack it with unxz"},
    {"\x28\xb5\x2f\xfd", "is compressed; unpack it with unzstd"},
    {"7z\xbc\xaf", "is a 7-Zip archive; unpack it with 7z"},
    {"\xff\xfe", utf16},
    {"\xfe\xff", utf16},
    {"solid ", "is an STL model; export it as OBJ or PLY"},
    {"glTF", "is a glTF model; export it as OBJ or PLY"},
    {"Kaydara FBX", "is an FBX model; export it as OBJ or PLY"},
    {"; FBX", "is an FBX model; export it as OBJ or PLY"},
    {"BLENDER", "is a Blender file; export it as OBJ or PLY"},
    {"OFF\n", "is an OFF model; export it as OBJ or PLY"},
    {"#VRML", "is a VRML model; export it as OBJ or PLY"},
    {"USDC", "is a USD scene; export it as OBJ or PLY"},
    {"#usda", "is a USD scene; export it as OBJ or PLY"},
    {"bplist", "is a binary property list; export the model as OBJ or PLY"},
    {"%PDF", "is a PDF document; use a model"},
    {"\x89PNG", "is a picture; use a model"},
    {"\xff\xd8\xff", "is a picture; use a model"},
    {"\x7f"
     "ELF",
     "is a program; use a model"}};

struct stat status_of(const FileDescriptor& file, const std::string& path) {
    struct stat status {};
    if (fstat(file.number(), &status) != 0) refuse_read(path, errno);
    return status;
}

}  // namespace

void require_size(const std::string& path, std::size_t size, std::size_t max_bytes) {
    if (size <= max_bytes) return;
    throw Error(ExitCode::limit,
                fmt::format("{}: the file is larger than {} MiB; split or shrink the scene",
                            printable(path), max_bytes >> 20));
}

FileDescriptor open_text_file(const std::string& path) {
    FileDescriptor file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
    if (!file) refuse_open(path, errno);
    const mode_t mode = status_of(file, path).st_mode;
    if (S_ISDIR(mode)) refuse(path, "is a directory; name a scene file in it");
    if (!S_ISREG(mode)) refuse(path, "is not a regular file; save the scene to a file first");
    return file;
}

FileText read_text_file(const FileDescriptor& file, const std::string& path,
                        std::size_t max_bytes) {
    const auto size = static_cast<std::size_t>(status_of(file, path).st_size);
    require_size(path, size, max_bytes);
    if (size == 0) return read_unsized(file, path, max_bytes);
    auto bytes = std::make_unique_for_overwrite<char[]>(size);
    std::vector<std::size_t> got((size + piece - 1) / piece);
    for_each_run(size, piece, available_cores(), [&](std::size_t first, std::size_t last) {
        got[first / piece] = read_at(file, path, bytes.get() + first, last - first, first);
    });
    std::size_t end = 0;  // less than `size` if the file was truncated meanwhile
    for (const std::size_t part : got) {
        end += part;
        if (part < piece) break;
    }
    return {std::move(bytes), end};
}

FileText read_text_file(const std::string& path, std::size_t max_bytes) {
    return read_text_file(open_text_file(path), path, max_bytes);
}

void refuse_foreign(const std::string& path, std::string_view text) {
    const std::size_t blanks = std::min(text.find_first_not_of(" \t\r\n"), text.size());
    const std::string start = lower(std::string(text.substr(blanks, 32)));
    for (const Foreign& foreign : foreign_starts) {
        if (start.starts_with(lower(std::string(foreign.start))))
            refuse(path, std::string(foreign.message));
    }
    const bool wide =
        text.size() > 3 && text[0] != 0 && text[1] == 0 && text[2] != 0 && text[3] == 0;
    if (wide) refuse(path, std::string(utf16));
}

}  // namespace rt
