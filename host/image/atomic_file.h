// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "host/base/files.h"
#include "host/image/output_path.h"

namespace rt {

/// Writes a file whole or not at all: to a temporary file in its directory, then fsync and rename.
/// A reader sees the old bytes or the new ones; without commit() the old ones stay. The temporary
/// file has no name until it is complete, so a killed process leaves none, except on file systems
/// that must name it (NFS).
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
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    void write(std::span<const std::byte> bytes);
    void commit();

   private:
    template <typename Create>
    void name_temporary(Create create);

    const std::string path_;
    const OutputDestination destination_;
    FileDescriptor file_;         ///< the temporary file, or the destination itself
    std::string temporary_name_;  ///< empty while it has none
};

/// Writes the whole file in one call.
void write_file_atomically(const std::string& path, std::span<const std::byte> bytes);

}  // namespace rt
