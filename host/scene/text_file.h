// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "host/base/file_descriptor.h"

namespace rt {

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

/// Throws Error (ExitCode::limit) when a text of `size` bytes is too large; `path` is its name in
/// messages.
void require_size(const std::string& path, std::size_t size, std::size_t max_bytes);

/// Opens a regular file. Throws Error, ExitCode::input with "path: what is wrong; what to do", when
/// it is missing, unreadable or not a regular file: a pipe or a device never hangs the program.
FileDescriptor open_text_file(const std::string& path);

/// Reads an open regular file; `path` is its name in messages. Large files are read on all cores.
/// Throws Error: ExitCode::input when it cannot be read, ExitCode::limit when it is larger than
/// `max_bytes`.
FileText read_text_file(const FileDescriptor& file, const std::string& path, std::size_t max_bytes);

/// Opens and reads a file.
FileText read_text_file(const std::string& path, std::size_t max_bytes);

/// Throws Error (ExitCode::input) for a text that begins as another kind of file does: a web page,
/// a Git LFS pointer, an archive, UTF-16, another model format. Says what it is and what to do.
void refuse_foreign(const std::string& path, std::string_view text);

}  // namespace rt
