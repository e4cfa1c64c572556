// SPDX-License-Identifier: Apache-2.0
#include "host/image/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <utility>

#include "host/image/output_path.h"

namespace rt {
namespace {

namespace fs = std::filesystem;

/// Owns an open file; close() is for when its result matters.
class OpenFile {
   public:
    explicit OpenFile(int number) : number_(number) {}
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    ~OpenFile() {
        if (number_ >= 0) ::close(number_);
    }

    int number() const { return number_; }
    bool close() { return ::close(std::exchange(number_, -1)) == 0 || errno == EINTR; }

   private:
    int number_;
};

/// Removes a file on the way out unless it has been kept.
class Leftover {
   public:
    explicit Leftover(std::string path) : path_(std::move(path)) {}
    Leftover(const Leftover&) = delete;
    Leftover& operator=(const Leftover&) = delete;
    ~Leftover() {
        if (!path_.empty()) ::unlink(path_.c_str());
    }

    void keep() { path_.clear(); }

   private:
    std::string path_;
};

void write_all(const std::string& path, int file, std::span<const std::byte> bytes) {
    constexpr std::size_t largest_write = std::size_t{1} << 30;
    while (!bytes.empty()) {
        const ssize_t count = ::write(file, bytes.data(), std::min(bytes.size(), largest_write));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail_to_write(path, errno);
        if (count == 0) fail_to_write(path, EIO);
        bytes = bytes.subspan(static_cast<std::size_t>(count));
    }
}

void write_in_place(const std::string& path, std::span<const std::byte> bytes) {
    OpenFile file(::open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
    if (file.number() < 0) fail_to_write(path, errno);
    write_all(path, file.number(), bytes);
    if (!file.close()) fail_to_write(path, errno);
}

/// Creates a file nobody else has, with the mode an ordinary new file would get.
std::pair<int, std::string> create_temporary(const std::string& path, const fs::path& directory) {
    static std::atomic<unsigned> serial{0};  // two threads may write at once
    for (int attempt = 0; attempt < 1000; ++attempt) {
        const std::string name = (directory / (".mirrorball-" + std::to_string(::getpid()) + "-" +
                                               std::to_string(serial++) + ".tmp"))
                                     .string();
        const int number = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (number >= 0) return {number, name};
        if (errno != EEXIST && errno != EINTR) fail_to_write(path, errno);
    }
    fail_to_write(path, EEXIST);
}

/// fsync, except where the file system has no such thing.
bool flush_to_disk(int file) {
    return ::fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS;
}

/// Best effort: only root may give a file away, and some file systems know no modes.
void keep_owner_and_mode(int file, const struct stat& existing) {
    if (::fchown(file, existing.st_uid, existing.st_gid) != 0) errno = 0;
    if (::fchmod(file, existing.st_mode & 0777) != 0) errno = 0;
}

}  // namespace

void write_file_atomically(const std::string& path, std::span<const std::byte> bytes) {
    const OutputDestination destination = find_output_destination(path);
    if (destination.in_place) return write_in_place(path, bytes);

    const fs::path directory = directory_of(destination.file);
    const auto [number, name] = create_temporary(path, directory);
    OpenFile temporary(number);
    Leftover leftover(name);
    if (destination.existing) keep_owner_and_mode(number, *destination.existing);
    write_all(path, number, bytes);
    if (!flush_to_disk(number)) fail_to_write(path, errno);
    if (!temporary.close()) fail_to_write(path, errno);
    if (::rename(name.c_str(), destination.file.c_str()) != 0) fail_to_write(path, errno);
    leftover.keep();

    const OpenFile entry(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (entry.number() >= 0) flush_to_disk(entry.number());
}

}  // namespace rt
