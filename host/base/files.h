// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <utility>

#include "host/base/error.h"

namespace rt {

/// Owns a file descriptor, or none (-1), and closes it on destruction; call close() when the result
/// matters.
class FileDescriptor {
   public:
    explicit FileDescriptor(int number = -1) : number_(number) {}
    FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    FileDescriptor& operator=(FileDescriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    ~FileDescriptor() {
        if (number_ >= 0) ::close(number_);
    }

    /// False with errno on failure; EINTR is no failure, since the file is closed anyway.
    bool close() { return ::close(std::exchange(number_, -1)) == 0 || errno == EINTR; }

    int number() const { return number_; }
    explicit operator bool() const { return number_ >= 0; }

   private:
    int number_;
};

/// The running program's file; empty if it is unknown.
std::filesystem::path program_file();

/// The first of these folders, relative to the program's, that holds the file; empty if none does.
std::filesystem::path beside_program(std::initializer_list<const char*> folders, const char* file);

/// An empty folder, deleted with its files on destruction; has no name if it could not be created.
/// A killed process leaves it to the system, which clears the folder of temporary files.
class TemporaryFolder {
   public:
    TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder();

    const std::string& name() const { return name_; }

   private:
    std::string name_;
};

/// One of the program's own modules: a shared library loaded on demand.
struct ModuleFile {
    const char* name;       ///< "libmirrorball_exr.so"
    std::uint32_t version;  ///< required of its interface, whose first member is its version
    std::string what;       ///< for messages: "the image library"
    std::string advice;     ///< what to do when it is missing
};

/// Loads a module, never unloads it, and returns its interface: what the one symbol that it
/// exports, mirrorball_module, returns. Throws Error(failure). It lies next to the executable, or
/// in the folder MIRRORBALL_MODULE_DIR, relative to the executable's, fixed when the program was
/// built.
const void* load_module(const ModuleFile& module, ExitCode failure);

}  // namespace rt
