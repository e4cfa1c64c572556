// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace rt {

/// Writes a file whole or not at all: into a temporary file beside it, fsync, rename over it.
/// A reader sees the old bytes or the new ones; after a failure the old ones are still there and
/// no temporary is left (a killed process may leave ".mirrorball-*.tmp").
///
/// A symlink is written through, never replaced. An existing file keeps its permissions and must
/// be writable; a new one gets 0666 less the umask. A hard link to the old file keeps the old
/// bytes. What cannot be renamed over (/dev/null, a pipe, /dev/stdout) is written in place.
///
/// Throws Error(ExitCode::output) "path: cannot write: reason; what to do". The reasons EFBIG and
/// EPIPE only arrive as such when the program ignores SIGXFSZ and SIGPIPE.
void write_file_atomically(const std::string& path, std::span<const std::byte> bytes);

}  // namespace rt
