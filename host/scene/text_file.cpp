// SPDX-License-Identifier: Apache-2.0
#include "host/scene/text_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "host/base/error.h"
#include "host/base/parallel.h"
#include "host/base/text.h"
#include "host/scene/words.h"

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

void require_size(const std::string& path, std::size_t size, std::size_t max_bytes) {
    if (size <= max_bytes) return;
    throw Error(ExitCode::limit,
                fmt::format("{}: the file is larger than {} MiB; split or shrink the scene",
                            printable(path), max_bytes >> 20));
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

struct Foreign {
    std::string_view start, message;
};

/// What programs give the name of a scene or model.
constexpr Foreign foreign_starts[] = {
    {"version https://git-lfs", "is a Git LFS pointer, not the file itself; run 'git lfs pull'"},
    {"<", "is a web page or XML; download the file itself, or export another format"},
    {"\xff\xfe", "is UTF-16 text; save it as UTF-8"},
    {"\xfe\xff", "is UTF-16 text; save it as UTF-8"}};

std::mutex asked_mutex;
std::optional<FileStates> asked_files;  // none before they are first taken

void note_asked(const std::string& path) {
    const std::scoped_lock lock(asked_mutex);
    if (asked_files) asked_files->try_emplace(path, state_of(path));
}

struct stat status_of(const FileDescriptor& file, const std::string& path) {
    struct stat status {};
    if (fstat(file.number(), &status) != 0) refuse_read(path, errno);
    return status;
}

[[noreturn]] void refuse(const char* what) {
    throw Error(ExitCode::input, fmt::format("stdin: {} ({})", what, std::strerror(errno)));
}

/// Whether stdin is already our copy: nothing else is sealed.
bool is_kept() {
    const int seals = fcntl(STDIN_FILENO, F_GET_SEALS);
    return seals != -1 && (seals & F_SEAL_WRITE) != 0;
}

namespace fs = std::filesystem;

/// "" means the working folder, which canonical() does not accept.
fs::path folder_or_here(const fs::path& folder) { return folder.empty() ? "." : folder; }

bool climbs(const fs::path& name) {
    return name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end();
}

bool lies_in(const fs::path& file, const fs::path& root) {
    return std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first == root.end();
}

}  // namespace

FileState state_of(const std::string& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) return {};
    return {status.st_ino, status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

FileStates take_asked_files() {
    const std::scoped_lock lock(asked_mutex);
    return std::exchange(asked_files, FileStates()).value_or(FileStates());
}

FileDescriptor open_text_file(const std::string& path) {
    note_asked(path);
    FileDescriptor file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
    if (!file) refuse_open(path, errno);
    const mode_t mode = status_of(file, path).st_mode;
    if (S_ISDIR(mode)) refuse(path, "is a directory; name a file in it");
    if (!S_ISREG(mode))
        refuse(path, "is not a regular file; save the scene to a file, or pipe JSON to -");
    return file;
}

FileText read_text_file(const FileDescriptor& file, const std::string& path,
                        std::size_t max_bytes) {
    const auto size = static_cast<std::size_t>(status_of(file, path).st_size);
    require_size(path, size, max_bytes);
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
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    for (const Foreign& foreign : foreign_starts) {
        if (text.starts_with(foreign.start)) refuse(path, std::string(foreign.message));
    }
}

void keep_stdin() {
    if (is_kept()) return;
    const FileDescriptor copy(memfd_create("scene", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    bool good = static_cast<bool>(copy);
    std::vector<char> bytes(1 << 16);
    std::size_t size = 0;
    while (const ssize_t got = read(STDIN_FILENO, bytes.data(), bytes.size())) {
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) refuse("cannot be read; send a scene to it");
        size += static_cast<std::size_t>(got);
        require_size("stdin", size, max_json_bytes);
        good = good && write(copy.number(), bytes.data(), static_cast<std::size_t>(got)) == got;
    }
    constexpr int seals = F_SEAL_WRITE | F_SEAL_GROW | F_SEAL_SHRINK | F_SEAL_SEAL;
    if (!good || fcntl(copy.number(), F_ADD_SEALS, seals) != 0 ||
        dup2(copy.number(), STDIN_FILENO) < 0) {
        refuse("cannot be kept in memory; save the scene to a file");
    }
}

FileText read_stdin() {
    keep_stdin();
    const FileDescriptor file(fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0));
    return read_text_file(file, "stdin", max_json_bytes);
}

SceneFolder SceneFolder::of(const std::string& scene_path) {
    const fs::path folder = fs::path(scene_path).parent_path();
    return {folder, folder};
}

OpenedFile open_beneath(const SceneFolder& folder, const std::string& name) {
    const auto problem = [&](std::string_view what) {
        return OpenedFile{FileDescriptor(), {}, fmt::format("{} {}", in_quotes(name), what)};
    };
    constexpr std::string_view outside = "is outside the scene's folder; move it into that folder";
    const std::string unreachable = fmt::format("cannot be found or opened in {}; check the name",
                                                in_quotes(folder_or_here(folder.base).string()));
    if (name.empty()) return problem("is not a file name; write one");
    if (climbs(name)) return problem(outside);
    const fs::path path = folder.base / name;
    note_asked(path.string());
    // The file that was found is the one that is read, even if names and links change meanwhile.
    const FileDescriptor found(open(path.c_str(), O_PATH | O_CLOEXEC));
    const std::string link = fmt::format("/proc/self/fd/{}", found.number());
    std::error_code error;
    const fs::path real = fs::read_symlink(link, error);
    if (error || name.find('\0') != name.npos) return problem(unreachable);
    const fs::path root = fs::canonical(folder_or_here(folder.root), error);
    if (error || !lies_in(real, root)) return problem(outside);
    const mode_t mode = status_of(found, path.string()).st_mode;
    if (!S_ISREG(mode)) return problem("is not a regular file; name one");
    FileDescriptor file(open(link.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file && errno == EACCES) return problem("cannot be read; check its permissions");
    if (!file) {
        throw Error(ExitCode::limit, fmt::format("{}: cannot be opened: {}; raise the limit",
                                                 in_quotes(name), std::strerror(errno)));
    }
    return {std::move(file), path.string(), {}};
}

}  // namespace rt
