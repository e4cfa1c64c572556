// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <string>

#include "host/file_descriptor.h"

namespace rt {

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

    const FileDescriptor& file() const { return file_; }

    /// Closes it and gives it that name; false with errno when either fails.
    bool rename_to(const std::filesystem::path& name);

   private:
    std::string name_;
    FileDescriptor file_;
    std::atomic<const char*>* listed_ = nullptr;  ///< where unlink_temporaries() finds the name
};

/// Removes the temporary files that this process has open. For signal handlers that end it.
void unlink_temporaries();

/// Removes the temporary files that killed processes left in a directory, never one that a living
/// process holds. Looks at each directory once; what cannot be read or removed stays.
void remove_abandoned_temporaries(const std::filesystem::path& directory);

}  // namespace rt
