// SPDX-License-Identifier: Apache-2.0
#include "host/base/files.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <chrono>
#include <system_error>

namespace rt {

namespace {

namespace fs = std::filesystem;

constexpr const char* prefix = "mirrorball.tmp.";

FileDescriptor open_folder(const fs::path& folder) {
    return FileDescriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
}

/// Whether it is this user's, old, and locked by nobody.
bool is_abandoned(const fs::path& folder) {
    const FileDescriptor opened = open_folder(folder);
    struct stat status {};
    if (!opened || ::fstat(opened.number(), &status) != 0 || status.st_uid != ::geteuid()) {
        return false;
    }
    const auto age = std::chrono::system_clock::now() -
                     std::chrono::system_clock::from_time_t(status.st_mtim.tv_sec);
    return age > std::chrono::hours(1) && ::flock(opened.number(), LOCK_EX | LOCK_NB) == 0;
}

void remove_abandoned(const fs::path& place) {
    std::error_code error;
    for (fs::directory_iterator entry(place, error); !error && entry != fs::directory_iterator();
         entry.increment(error)) {
        if (!entry->path().filename().native().starts_with(prefix)) continue;
        std::error_code failed;
        if (is_abandoned(entry->path())) fs::remove_all(entry->path(), failed);
    }
}

}  // namespace

fs::path program_file() {
    std::error_code error;
    return fs::read_symlink("/proc/self/exe", error);
}

fs::path beside_program(std::initializer_list<const char*> folders, const char* file) {
    std::error_code error;
    for (const char* folder : folders) {
        const fs::path place = (program_file().parent_path() / folder).lexically_normal();
        if (fs::exists(place / file, error)) return place;
    }
    return {};
}

TemporaryFolder::TemporaryFolder() {
    std::error_code error;
    const fs::path place = fs::temp_directory_path(error);
    remove_abandoned(place);
    std::string name = place / (prefix + std::string("XXXXXX"));
    if (::mkdtemp(name.data()) == nullptr) return;
    name_ = name;
    lock_ = open_folder(name);
    if (lock_) ::flock(lock_.number(), LOCK_EX | LOCK_NB);
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code error;
    if (!name_.empty()) fs::remove_all(name_, error);
}

}  // namespace rt
