// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "host/image/output_path.h"
#include "host/image/temporary_file.h"

namespace rt {

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
