// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cerrno>
#include <utility>

namespace rt {

/// An open file of the system's, or none (-1). Closed with this; close() is for when its result
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

    /// False with errno when that fails; an interruption is no failure, the file is closed.
    bool close() { return ::close(std::exchange(number_, -1)) == 0 || errno == EINTR; }

    int number() const { return number_; }
    explicit operator bool() const { return number_ >= 0; }

   private:
    int number_;
};

}  // namespace rt
