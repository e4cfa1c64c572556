// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/base/error.h"
#include "host/base/files.h"

namespace rt {

/// The path that means standard output.
constexpr const char* stdout_path = "-";

/// Where the bytes written to a path really go.
struct OutputDestination {
    std::filesystem::path file;  // after following all symlinks
    bool in_place = false;       // a device, a pipe, an open file: never renamed over
    std::optional<struct stat> existing;
};

/// Resolves the path; throws Error(ExitCode::output) if it cannot be written: a directory, a block
/// device, a read-only file.
OutputDestination find_output_destination(const std::string& path);

/// Throws the Error that write_file_atomically would throw before writing: the directory is missing
/// or not writable, the path is a directory, the file there is read-only. Writes nothing; meant to
/// be called before a long computation.
void check_output_path(const std::string& path);

/// Throws Error (ExitCode::output) for a picture that cannot be encoded.
[[noreturn]] void fail_to_encode(const std::string& path, const std::string& reason);

/// Creates a folder and its parents. Throws Error (ExitCode::output).
void create_output_folder(const std::string& folder);

/// Where an unfinished picture goes: "dir/out.partial.png" for "dir/out.png". A name that gets too
/// long is cut.
std::string partial_path(const std::string& path);

/// Files that are read or written, so that no output may replace them.
class UsedFiles {
   public:
    UsedFiles() = default;
    explicit UsedFiles(const std::vector<std::string>& paths) {
        for (const std::string& path : paths) add(path);
    }

    void add(const std::string& path);

    /// Throws Error(ExitCode::usage) when the output is one of them under any name or link. An
    /// empty name, "-", devices and pipes never match.
    void check(const std::string& output) const;

   private:
    std::map<std::string, std::string> names_;  ///< by what is the same for all names of a file
};

/// Checks that no output is another one, or in use.
void check_outputs(const std::vector<std::string>& outputs, UsedFiles used = {});

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
