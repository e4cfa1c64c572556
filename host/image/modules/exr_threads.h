// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rt {

/// Runs OpenEXR with one thread per core while a picture is compressed or decompressed; with no
/// extra threads if it has few rows or the system can start no more.
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

}  // namespace rt
