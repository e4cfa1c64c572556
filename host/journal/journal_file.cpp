// SPDX-License-Identifier: Apache-2.0
#include "host/journal/journal_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <utility>

#include "host/base/error.h"

namespace rt {

namespace {

constexpr const char* is_of_another_process = ": another process is rendering this picture";

bool is_start_of_magic(std::string_view bytes) {
    return bytes.size() < journal_magic.size() && journal_magic.starts_with(bytes);
}

}  // namespace

JournalFile::JournalFile(std::string path) : path_(std::move(path)) { open_existing(); }

void JournalFile::open_existing() {
    struct stat status {};
    if (::lstat(path_.c_str(), &status) != 0) return;
    found_ = Found::something_else;
    if (!S_ISREG(status.st_mode)) return;
    FileDescriptor file(::open(path_.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW));
    if (!file) return;
    const bool is_ours = lock(file);
    if (::fstat(file.number(), &status) != 0) return;
    const auto size = static_cast<std::uint64_t>(status.st_size);
    if (!is_ours) {
        throw Error(ExitCode::output, path_ + is_of_another_process +
                                          "; wait for it to finish, or choose another output");
    }
    char magic[journal_magic.size()];
    const ssize_t got = ::pread(file.number(), magic, sizeof(magic), 0);
    const std::string_view bytes(magic, got > 0 ? static_cast<std::size_t>(got) : 0);
    if (is_start_of_magic(bytes)) {
        found_ = Found::nothing;  // the process that created it ended before its first record
    } else if (bytes.starts_with(journal_magic.substr(0, 6))) {
        found_ = Found::journal;
    } else {
        return;
    }
    file_ = std::move(file);
    end_ = size;
}

/// Locks the file if no other process has, and checks that it still has that name. Succeeds on file
/// systems without locks.
bool JournalFile::lock(const FileDescriptor& file) const {
    if (::flock(file.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return false;
    struct stat ours {
    }, named{};
    return ::fstat(file.number(), &ours) == 0 && ::lstat(path_.c_str(), &named) == 0 &&
           ours.st_dev == named.st_dev && ours.st_ino == named.st_ino;
}

void JournalFile::read(const std::function<void(JournalReader&)>& read) {
    std::ifstream stream(path_, std::ios::binary);
    JournalReader reader(stream, end_);
    read(reader);
    end_ = reader.good_bytes();
}

void JournalFile::restart(std::vector<std::byte> start) {
    start_ = std::move(start);
    end_ = 0;
}

void JournalFile::fail(const char* what, int error) {
    failure_ =
        fmt::format("{}: cannot {}: {}", path_, what, std::generic_category().message(error));
}

/// Fails when another process has created it since.
bool JournalFile::create() {
    FileDescriptor file(::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file && lock(file)) {
        file_ = std::move(file);
    } else if (file || errno == EEXIST) {
        failure_ = path_ + is_of_another_process;
    } else {
        fail("create", errno);
    }
    return failure_.empty();
}

bool JournalFile::write_all(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written =
            ::pwrite(file_.number(), bytes.data(), bytes.size(), static_cast<off_t>(end_));
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) {
            fail("write", written < 0 ? errno : EIO);
            return false;
        }
        end_ += static_cast<std::uint64_t>(written);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return true;
}

void JournalFile::append(std::span<const std::byte> records) {
    if (!failure_.empty()) return;
    if (!file_ && !create()) return;
    const std::uint64_t before = end_;
    if (::ftruncate(file_.number(), static_cast<off_t>(end_)) != 0) return fail("cut", errno);
    if (!exists()) found_ = Found::nothing;
    if (!write_all(start_) || !write_all(records)) {
        // The old contents stay valid; if this fails too, readers stop at the first bad record.
        [[maybe_unused]] const int ignored =
            ::ftruncate(file_.number(), static_cast<off_t>(before));
        return;
    }
    start_.clear();
    if (::fdatasync(file_.number()) != 0 && errno != EINVAL && errno != ENOTSUP) {
        fail("write", errno);
    }
}

void JournalFile::remove() {
    if (!file_) return;
    const bool is_of_another_picture = !exists() && found_ == Found::journal;
    if (!is_of_another_picture) ::unlink(path_.c_str());
    file_ = FileDescriptor();
}

}  // namespace rt
