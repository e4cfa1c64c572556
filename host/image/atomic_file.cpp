// SPDX-License-Identifier: Apache-2.0
#include "host/image/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>

namespace rt {
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
    constexpr std::size_t largest_write = std::size_t{1} << 30;
    while (!bytes.empty()) {
        const ssize_t count =
            ::write(file_.number(), bytes.data(), std::min(bytes.size(), largest_write));
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
