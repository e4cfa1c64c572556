// SPDX-License-Identifier: Apache-2.0
#include "host/image/atomic_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <mutex>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

namespace rt {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view prefix = ".mirrorball-";
constexpr std::string_view suffix = ".tmp";

/// Names of the open temporary files; those beyond the last slot are not listed.
std::array<std::atomic<const char*>, 16> open_names;
static_assert(std::atomic<const char*>::is_always_lock_free);

std::atomic<const char*>* list_name(const char* name) {
    for (std::atomic<const char*>& slot : open_names) {
        const char* none = nullptr;
        if (slot.compare_exchange_strong(none, name)) return &slot;
    }
    return nullptr;
}

/// Locks a file just created and returns whether it still exists: a cleanup may have removed it
/// first. Without file system locks, cleanup removes nothing.
bool lock_new_file(int file) {
    while (::flock(file, LOCK_EX) != 0 && errno == EINTR) {
    }
    struct stat status {};
    return ::fstat(file, &status) == 0 && status.st_nlink > 0;
}

/// The process ID in a temporary file's name; 0 for other names.
pid_t process_of(std::string_view name) {
    if (!name.starts_with(prefix) || !name.ends_with(suffix)) return 0;
    pid_t process = 0;
    const char* first = name.data() + prefix.size();
    const auto [end, error] = std::from_chars(first, name.data() + name.size(), process);
    return error == std::errc() && process > 0 && *end == '-' ? process : 0;
}

bool is_running(pid_t process) { return ::kill(process, 0) == 0 || errno != ESRCH; }

/// Unlinks only while holding the lock, so that no live file is removed.
void remove_if_abandoned(const fs::path& file) {
    const FileDescriptor open(::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    struct stat status {};
    if (open.number() < 0 || ::fstat(open.number(), &status) != 0) return;
    if (!S_ISREG(status.st_mode) || status.st_uid != ::geteuid()) return;
    if (::flock(open.number(), LOCK_EX | LOCK_NB) == 0) ::unlink(file.c_str());
}

bool first_time(const fs::path& directory) {
    static std::mutex mutex;
    static std::set<std::string> seen;
    const std::scoped_lock lock(mutex);
    return seen.insert(directory.string()).second;
}

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

TemporaryFile::TemporaryFile(const std::string& path, const fs::path& directory) {
    static std::atomic<unsigned> serial{0};  // two threads may write at once
    const std::string start = std::string(prefix) + std::to_string(::getpid()) + "-";
    for (int attempt = 0; attempt < 1000; ++attempt) {
        const std::string name =
            (directory / (start + std::to_string(serial++) + std::string(suffix))).string();
        FileDescriptor file(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
        if (file.number() < 0 && errno != EEXIST && errno != EINTR) fail_to_write(path, errno);
        if (file.number() < 0 || !lock_new_file(file.number())) continue;
        name_ = name;
        file_ = std::move(file);
        listed_ = list_name(name_.c_str());
        return;
    }
    fail_to_write(path, EEXIST);
}

TemporaryFile::~TemporaryFile() {
    if (!name_.empty()) ::unlink(name_.c_str());
    if (listed_ != nullptr) *listed_ = nullptr;
}

void unlink_temporaries() {
    for (const std::atomic<const char*>& slot : open_names) {
        if (const char* name = slot) ::unlink(name);
    }
}

bool TemporaryFile::rename_to(const fs::path& name) {
    // Keeps the lock while renaming, so that nobody takes the file for abandoned in between.
    const FileDescriptor lock(::dup(file_.number()));
    if (!file_.close() || ::rename(name_.c_str(), name.c_str()) != 0) return false;
    if (listed_ != nullptr) *std::exchange(listed_, nullptr) = nullptr;
    name_.clear();
    return true;
}

void remove_abandoned_temporaries(const fs::path& directory) {
    if (!first_time(directory)) return;
    std::error_code error;
    for (fs::directory_iterator entry(directory, error), end; !error && entry != end;
         entry.increment(error)) {
        const pid_t process = process_of(entry->path().filename().native());
        if (process != 0 && !is_running(process)) remove_if_abandoned(entry->path());
    }
}

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
