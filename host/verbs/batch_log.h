// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "host/base/files.h"

namespace rt {

/// What a batch has read and finished, in memory that outlives the worker process: the next one
/// starts from there. Each record is a line: 'l' and a line of the list, or 'f', the number of a
/// picture and its exit status.
class BatchLog {
   public:
    /// Memory for a log, inherited by child processes; none if there is not enough.
    static FileDescriptor make_memory();

    /// Reads the existing log. `descriptor`: the memory's number; empty: nothing is kept.
    explicit BatchLog(const std::string& descriptor);

    /// The next line of the list that an earlier process has read.
    std::optional<std::string> next_line();

    std::optional<int> status_of(std::size_t picture) const;
    std::size_t finished() const { return statuses_.size(); }

    void add_line(const std::string& line) { append("l" + line); }
    void add_finished(std::size_t picture, int status);

    std::size_t bytes_of_lines() const { return bytes_of_lines_; }

   private:
    void append(const std::string& record) const;

    int memory_ = -1;
    std::deque<std::string> lines_;
    std::size_t bytes_of_lines_ = 0;  ///< of the lines that an earlier process has read
    std::map<std::size_t, int> statuses_;
};

}  // namespace rt
