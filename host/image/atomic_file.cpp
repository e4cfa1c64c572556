// SPDX-License-Identifier: Apache-2.0
#include "host/image/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>

namespace rt {
namespace {

namespace fs = std::filesystem;

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
    FileDescriptor file(path == stdout_path
                            ? ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0)
                            : ::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
    if (file.number() < 0) fail_to_write(path, errno);
    return file;
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path)
    : path_(path), destination_(find_output_destination(path)) {
    if (destination_.in_place) {
        file_ = open_in_place(path);
        return;
    }
    const fs::path directory = directory_of(destination_.file);
    remove_abandoned_temporaries(directory);
    temporary_.emplace(path, directory);
    if (destination_.existing) {
        keep_owner_and_mode(temporary_->file().number(), *destination_.existing);
    }
}

void AtomicFile::write(std::span<const std::byte> bytes) {
    constexpr std::size_t largest_write = std::size_t{1} << 30;
    const int file = temporary_ ? temporary_->file().number() : file_.number();
    while (!bytes.empty()) {
        const ssize_t count = ::write(file, bytes.data(), std::min(bytes.size(), largest_write));
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
    if (!flush_to_disk(temporary_->file().number())) fail_to_write(path_, errno);
    if (!temporary_->rename_to(destination_.file)) fail_to_write(path_, errno);
    const FileDescriptor entry(
        ::open(directory_of(destination_.file).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (entry.number() >= 0) flush_to_disk(entry.number());
}

void write_file_atomically(const std::string& path, std::span<const std::byte> bytes) {
    AtomicFile file(path);
    file.write(bytes);
    file.commit();
}

}  // namespace rt
