// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>

namespace rt {

/// Owns an open file; close() is for when its result matters.
class OpenFile {
   public:
    explicit OpenFile(int number = -1) : number_(number) {}
    OpenFile(OpenFile&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    OpenFile& operator=(OpenFile&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    ~OpenFile();

    int number() const { return number_; }
    bool close();

   private:
    int number_;
};

/// A new file ".mirrorball-PID-SERIAL.tmp" in a directory, with the mode an ordinary new file
/// would get; it is removed again unless it is renamed. As long as it is open its process holds
/// a lock on it (flock), which tells others that it is in use.
class TemporaryFile {
   public:
    /// Throws Error(ExitCode::output) naming `path`, which the file is for.
    TemporaryFile(const std::string& path, const std::filesystem::path& directory);
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile();

    const OpenFile& file() const { return file_; }

    /// Closes it and gives it that name; false with errno when either fails.
    bool rename_to(const std::filesystem::path& name);

   private:
    std::string name_;
    OpenFile file_;
};

/// Removes the temporary files that killed processes left in a directory, never one that a living
/// process holds. Looks at each directory once; what cannot be read or removed stays.
void remove_abandoned_temporaries(const std::filesystem::path& directory);

}  // namespace rt
