// SPDX-License-Identifier: Apache-2.0
#include "host/image/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/magic.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>

#include "host/base/text.h"

namespace rt {

namespace {

namespace fs = std::filesystem;

std::string advice(int error) {
    switch (error) {
        case ENOSPC:
        case EDQUOT:
            return "free some space or write to another disk";
        case EFBIG:
            return "raise the file size limit (ulimit -f) or make the picture smaller";
        case EACCES:
        case EPERM:
        case EROFS:
            return "choose a writable location";
        case ENOENT:
        case ENOTDIR:
            return "create the directory first";
        case EISDIR:
            return "name a file, not a directory";
        case ENAMETOOLONG:
            return "use a shorter name";
        default:
            return "write somewhere else";
    }
}

/// Throws Error(ExitCode::output) "path: cannot write: reason; what to do".
[[noreturn]] void fail_to_write(const std::string& path, int error) {
    throw Error(
        ExitCode::output,
        path + ": cannot write: " + std::generic_category().message(error) + "; " + advice(error));
}

/// "." for a bare name.
fs::path directory_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

bool is_on_procfs(const fs::path& directory) {
    struct statfs status {};
    return ::statfs(directory.c_str(), &status) == 0 && status.f_type == PROC_SUPER_MAGIC;
}

/// Follows symlinks to a file that may not exist; empty when a link is one of the kernel's
/// (/dev/stdout leads to one): these lead to open files, not to names.
std::optional<fs::path> follow_links(const std::string& path) {
    fs::path file = path;
    for (int depth = 0; depth < 40; ++depth) {
        std::error_code error;
        if (!fs::is_symlink(file, error)) return file;
        if (is_on_procfs(directory_of(file))) return std::nullopt;
        const fs::path target = fs::read_symlink(file, error);
        if (error) fail_to_write(path, error.value());
        file = file.parent_path() / target;
    }
    fail_to_write(path, ELOOP);
}

}  // namespace

OutputDestination find_output_destination(const std::string& path) {
    OutputDestination destination{path, path == stdout_path, std::nullopt};
    if (destination.in_place) return destination;
    struct stat status {};
    if (::stat(path.c_str(), &status) == 0) {
        if (S_ISDIR(status.st_mode)) fail_to_write(path, EISDIR);
        if (S_ISBLK(status.st_mode) || S_ISSOCK(status.st_mode)) fail_to_write(path, ENOTSUP);
        if (::access(path.c_str(), W_OK) != 0) fail_to_write(path, errno);
        destination.existing = status;
        destination.in_place = !S_ISREG(status.st_mode);
    } else if (errno != ENOENT) {
        fail_to_write(path, errno);
    }
    if (destination.in_place) return destination;
    if (const auto file = follow_links(path)) {
        destination.file = *file;
        if (!file->empty() && !file->has_filename()) fail_to_write(path, EISDIR);
        if (file->empty()) fail_to_write(path, ENOENT);
    } else {
        destination.in_place = true;
    }
    return destination;
}

void check_output_path(const std::string& path) {
    const OutputDestination destination = find_output_destination(path);
    if (destination.in_place) return;
    const fs::path directory = directory_of(destination.file);
    struct stat status {};
    if (::stat(directory.c_str(), &status) != 0) fail_to_write(path, errno);
    if (!S_ISDIR(status.st_mode)) fail_to_write(path, ENOTDIR);
    if (::access(directory.c_str(), W_OK | X_OK) != 0) fail_to_write(path, errno);
}

void fail_to_encode(const std::string& path, const std::string& reason) {
    throw Error(ExitCode::output, path + ": cannot encode the picture: " + reason +
                                      "; try .pfm, which needs no library");
}

void create_output_folder(const std::string& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (!error) return;
    throw Error(ExitCode::output, folder + ": cannot create the folder: " + error.message());
}

std::string partial_path(const std::string& path) {
    constexpr std::size_t longest = 255;  // names in file systems, in bytes
    const fs::path name(path);
    const std::string ending = ".partial" + name.extension().string();
    std::string stem = name.stem().string();
    // Whole characters of UTF-8.
    while (stem.size() > 1 && stem.size() + ending.size() > longest) {
        while (is_utf8_continuation(stem.back())) stem.pop_back();
        stem.pop_back();
    }
    return (name.parent_path() / (stem + ending)).string();
}

namespace {

/// The same for all names of a regular file, which need not exist yet; empty for anything else.
std::string identity(const std::string& path) {
    struct stat status {};
    if (path.empty() || path == stdout_path) return "";
    if (::stat(path.c_str(), &status) == 0) {
        return S_ISREG(status.st_mode) ? fmt::format("{}:{}", status.st_dev, status.st_ino) : "";
    }
    if (errno != ENOENT) return "";  // whoever opens it says why it cannot be
    std::error_code error;
    const auto target = follow_links(path);
    return target ? fs::weakly_canonical(fs::absolute(*target), error).string() : "";
}

}  // namespace

void UsedFiles::add(const std::string& path) {
    const std::string file = identity(path);
    if (!file.empty()) names_.try_emplace(file, path);
}

void UsedFiles::check(const std::string& output) const {
    const auto found = names_.find(identity(output));
    if (found == names_.end()) return;
    usage_error("{}: is the same file as {}; choose another output", output, found->second);
}

void check_outputs(const std::vector<std::string>& outputs, UsedFiles used) {
    for (const std::string& output : outputs) {
        used.check(output);
        used.add(output);
    }
}

namespace {

/// fsync, except where the file system does not support it.
bool flush_to_disk(int file) {
    return ::fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS;
}

/// Best effort: only root may change owners, and some file systems have no modes.
void keep_owner_and_mode(int file, const struct stat& existing) {
    if (::fchown(file, existing.st_uid, existing.st_gid) != 0) errno = 0;
    if (::fchmod(file, existing.st_mode & 0777) != 0) errno = 0;
}

FileDescriptor open_in_place(const std::string& path) {
    if (path == stdout_path) return FileDescriptor(::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0));
    return FileDescriptor(::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path)
    : path_(path), destination_(find_output_destination(path)) {
    if (destination_.in_place) {
        file_ = open_in_place(path);
    } else {
        const auto directory = directory_of(destination_.file);
        file_ = FileDescriptor(::open(directory.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666));
        if (!file_ && (errno == EOPNOTSUPP || errno == EISDIR)) {
            name_temporary([&](const char* name) {
                constexpr int flags = O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC;
                file_ = FileDescriptor(::open(name, flags, 0666));
                return static_cast<bool>(file_);
            });
        }
    }
    if (!file_) fail_to_write(path, errno);
    if (!destination_.in_place && destination_.existing) {
        keep_owner_and_mode(file_.number(), *destination_.existing);
    }
}

AtomicFile::~AtomicFile() {
    if (!temporary_name_.empty()) ::unlink(temporary_name_.c_str());
}

/// Calls create(name), which fails with errno, with names until one is not in use.
template <typename Create>
void AtomicFile::name_temporary(Create create) {
    static std::atomic<unsigned> serial{0};  // two threads may write at once
    const std::filesystem::path directory = directory_of(destination_.file);
    std::string name;
    do {
        name = directory / fmt::format(".mirrorball-{}-{}.tmp", ::getpid(), serial++);
        if (create(name.c_str())) temporary_name_ = name;
    } while (temporary_name_.empty() && (errno == EEXIST || errno == EINTR));
    if (temporary_name_.empty()) fail_to_write(path_, errno);
}

void AtomicFile::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(file_.number(), bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail_to_write(path_, errno);
        if (count == 0) fail_to_write(path_, EIO);
        bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
}

void AtomicFile::commit() {
    if (destination_.in_place) {
        if (!file_.close()) fail_to_write(path_, errno);
        return;
    }
    if (!flush_to_disk(file_.number())) fail_to_write(path_, errno);
    if (temporary_name_.empty()) {
        const std::string unnamed = fmt::format("/proc/self/fd/{}", file_.number());
        name_temporary([&](const char* name) {
            return ::linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0;
        });
    }
    if (!file_.close() || ::rename(temporary_name_.c_str(), destination_.file.c_str()) != 0) {
        fail_to_write(path_, errno);
    }
    temporary_name_.clear();
    const FileDescriptor entry(
        ::open(directory_of(destination_.file).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (entry) flush_to_disk(entry.number());
}

void write_file_atomically(const std::string& path, std::span<const std::byte> bytes) {
    AtomicFile file(path);
    file.write(bytes);
    file.commit();
}

}  // namespace rt
