// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <string>

#include "host/base/files.h"

namespace rt {

/// A new file ".mirrorball-PID-SERIAL.tmp" in a directory, with the mode of an ordinary new file;
/// it is deleted unless renamed. While it is open, its process holds a lock on it (flock) to mark
/// it as in use.
class TemporaryFile {
   public:
    /// Throws Error(ExitCode::output) naming `path`, the file it will become.
    TemporaryFile(const std::string& path, const std::filesystem::path& directory);
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile();

    const FileDescriptor& file() const { return file_; }

    /// Closes it and renames it; false with errno when either fails.
    bool rename_to(const std::filesystem::path& name);

   private:
    std::string name_;
    FileDescriptor file_;
    std::atomic<const char*>* listed_ = nullptr;  ///< its slot for unlink_temporaries()
};

/// Removes this process's open temporary files. For signal handlers that end the process.
void unlink_temporaries();

/// Removes temporary files that killed processes left in a directory, never one that a living
/// process holds. Scans each directory only once; ignores what cannot be read or removed.
void remove_abandoned_temporaries(const std::filesystem::path& directory);

}  // namespace rt
