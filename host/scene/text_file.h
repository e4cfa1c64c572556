// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>

#include "host/base/files.h"

namespace rt {

inline constexpr std::size_t max_json_bytes = std::size_t{256} << 20;

/// What a file held when it was read.
class FileText {
   public:
    FileText() = default;
    FileText(std::unique_ptr<char[]> bytes, std::size_t size)
        : bytes_(std::move(bytes)), size_(size) {}

    std::string_view view() const { return {bytes_.get(), size_}; }

   private:
    std::unique_ptr<char[]> bytes_;
    std::size_t size_ = 0;
};

/// What changes when a file is written in place or replaced: inode, size and time; zeros if it does
/// not exist.
using FileState = std::tuple<ino_t, off_t, std::int64_t, std::int64_t>;
using FileStates = std::map<std::string, FileState>;
FileState state_of(const std::string& path);

/// The files that open_text_file and open_beneath were asked for since the last call, there or not,
/// and their states just before that; none by the first call, from which on they are noted.
FileStates take_asked_files();

/// Opens a regular file. Throws Error, ExitCode::input with "path: what is wrong; what to do", when
/// it is missing, unreadable or not a regular file: a pipe or a device never hangs the program.
FileDescriptor open_text_file(const std::string& path);

/// Reads an open regular file; `path` is its name in messages. Large files are read on all cores.
/// Throws Error: ExitCode::input when it cannot be read, ExitCode::limit when it is larger than
/// `max_bytes`.
FileText read_text_file(const FileDescriptor& file, const std::string& path, std::size_t max_bytes);

/// Opens and reads a file.
FileText read_text_file(const std::string& path, std::size_t max_bytes);

/// Throws Error (ExitCode::input) for a text that begins as a web page, a Git LFS pointer or UTF-16
/// does. Says what it is and what to do.
void refuse_foreign(const std::string& path, std::string_view text);

/// Reads standard input to its end and replaces it with a copy that this process and its children
/// can reread. Later calls do nothing. Throws Error: ExitCode::input when it cannot be read,
/// ExitCode::limit when it is too large for a scene.
void keep_stdin();

/// All of standard input. Throws like keep_stdin.
FileText read_stdin();

/// Where the files that a scene refers to may be.
struct SceneFolder {
    std::filesystem::path root;  ///< nothing outside of it is read
    std::filesystem::path base;  ///< names are relative to it

    /// For the scene in this file: both are the folder that contains it.
    static SceneFolder of(const std::string& scene_path);
};

/// An open file, or why it could not be opened.
struct OpenedFile {
    FileDescriptor file;
    std::string path;     ///< for messages
    std::string problem;  ///< "what is wrong; what to do"; empty on success
};

/// Opens the regular file that a scene calls `name`. Refuses absolute names, "..", and symbolic
/// links that lead out of the folder. The opened file lies beneath the folder even if files and
/// links are replaced meanwhile. Throws Error (ExitCode::limit) if the system allows no more files.
OpenedFile open_beneath(const SceneFolder& folder, const std::string& name);

}  // namespace rt
