// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "host/base/error.h"

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

/// "." for a bare name.
std::filesystem::path directory_of(const std::filesystem::path& file);

/// Throws Error(ExitCode::output) "path: cannot write: reason; what to do".
[[noreturn]] void fail_to_write(const std::string& path, int error);

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

}  // namespace rt
