// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rt::module {

/// OpenEXR's threads, one a core, while a picture is compressed or expanded; none where it has few
/// rows or the system starts no more threads, and then all is done by the caller.
class ExrThreads {
   public:
    explicit ExrThreads(int rows);
    ExrThreads(const ExrThreads&) = delete;
    ExrThreads& operator=(const ExrThreads&) = delete;
    ~ExrThreads();

    int count() const { return count_; }

   private:
    int count_ = 0;
};

}  // namespace rt::module
