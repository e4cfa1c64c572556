// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "host/base/files.h"
#include "host/image/output_path.h"

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

/// Writes a file whole or not at all: to a temporary file next to it, then fsync and rename. A
/// reader sees the old bytes or the new ones; without commit() the old ones stay and no temporary
/// is left (those of killed processes are removed the next time a file is written there).
///
/// A symlink is written through, never replaced. An existing file keeps its permissions and must
/// be writable; a new one gets 0666 less the umask. A hard link to the old file keeps the old
/// bytes. What cannot be renamed over (/dev/null, a pipe, standard output) is written in place.
///
/// Throws Error(ExitCode::output) "path: cannot write: reason; what to do". The reasons EFBIG and
/// EPIPE only arrive as such when the program ignores SIGXFSZ and SIGPIPE.
class AtomicFile {
   public:
    explicit AtomicFile(const std::string& path);

    void write(std::span<const std::byte> bytes);
    void commit();

   private:
    const std::string path_;
    const OutputDestination destination_;
    std::optional<TemporaryFile> temporary_;
    FileDescriptor file_;  ///< the temporary one, or the destination itself
};

/// Writes the whole file in one call.
void write_file_atomically(const std::string& path, std::span<const std::byte> bytes);

}  // namespace rt
