// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "host/base/files.h"
#include "host/journal/journal_reader.h"

namespace rt {

/// An on-disk journal that one process appends to while holding a lock on it (flock). It is created
/// with the first record. Later failures are stored as a message, not thrown: rendering continues
/// without the journal.
class JournalFile {
   public:
    /// What was found at the journal's path.
    enum class Found { nothing, journal, something_else };

    /// Throws Error (ExitCode::output) when another process holds its lock.
    explicit JournalFile(std::string path);

    Found found() const { return found_; }
    const std::string& path() const { return path_; }

    /// Calls `read` with the existing journal. Anything after its last good record is cut off on
    /// the next write. Throws Error (ExitCode::input) when its header cannot be read.
    void read(const std::function<void(JournalReader&)>& read);

    /// Replaces its contents on the next write, which begins with what `start` returns.
    void restart(std::function<std::vector<std::byte>()> start);

    /// Whether the file exists and holds this picture.
    bool exists() const { return file_ && !start_; }

    /// Appends whole records and flushes them to disk. Throws Error (ExitCode::output) when another
    /// process has created it since, and holds its lock.
    void append(std::span<const std::byte> records);

    /// Truncates the existing file at once; restart sets what is written next.
    void empty();

    /// Removes the file, unless it holds another picture: restarted, and nothing written since.
    void remove();

    /// Removes the file while `work` needs its space on the disk; puts it back if that throws
    /// Error.
    void make_room(const std::function<void()>& work);

    /// Stops writing and stores the reason.
    void give_up(const std::string& why) { failure_ = path_ + ": " + why; }

    /// Why writing stopped; empty if it did not.
    const std::string& failure() const { return failure_; }

   private:
    void open_existing();
    bool lock(const FileDescriptor& file) const;
    bool create();
    bool write_all(std::span<const std::byte> bytes);
    void fail(const char* what, int error);

    const std::string path_;
    FileDescriptor file_;
    Found found_ = Found::nothing;
    std::string failure_;
    std::uint64_t end_ = 0;                          ///< length of the good part
    std::function<std::vector<std::byte>()> start_;  ///< empty once it is written
};

}  // namespace rt
