// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "host/file_descriptor.h"
#include "host/journal/journal_reader.h"

namespace rt {

/// A journal on disk that one process appends to, and holds a lock on (flock) meanwhile. It is made
/// when the first record is written. What fails from then on is kept as a sentence, not thrown: a
/// picture goes on without its journal.
class JournalFile {
   public:
    /// What was found in the place of a journal.
    enum class Found { nothing, journal, something_else };

    /// Throws Error (ExitCode::output) when another process holds its lock.
    explicit JournalFile(std::string path);

    Found found() const { return found_; }
    const std::string& path() const { return path_; }

    /// Calls `read` with the journal that was found. What follows its last good record goes when
    /// the next is written. Throws Error (ExitCode::input) when its header cannot be read.
    void read(const std::function<void(JournalReader&)>& read);

    /// Empties it when it is next written, which begins with what `start` gives.
    void restart(std::function<std::vector<std::byte>()> start);

    /// Whether a file is there.
    bool exists() const { return static_cast<bool>(file_); }

    /// Appends whole records and has the disk keep them.
    void append(std::span<const std::byte> records);

    /// Makes the file that is there empty at once; restart says what is written next.
    void empty();

    /// Removes the file.
    void remove();

    /// Writes no more, and keeps why.
    void give_up(const std::string& why) { failure_ = path_ + ": " + why; }

    /// Why it is no longer written; empty while all is well.
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
    std::uint64_t end_ = 0;                          ///< bytes that are good
    std::function<std::vector<std::byte>()> start_;  ///< empty once it is written
};

}  // namespace rt
