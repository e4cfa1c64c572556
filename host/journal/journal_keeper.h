// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "host/journal/journal_file.h"
#include "host/render/film.h"
#include "host/render/stopwatch.h"

namespace rt {

/// Writes what is finished of a film to its journal every second, from a thread of its own, which
/// is started when `delay` seconds have passed: what takes less writes nothing.
template <typename T>
class JournalKeeper {
   public:
    /// `writer` is the record that says who we are. The film must outlive this and shows `shown`.
    JournalKeeper(JournalFile& file, const JournalWriterInfo& writer, const Film<T>& film,
                  const Rect& shown, double delay);
    JournalKeeper(const JournalKeeper&) = delete;
    JournalKeeper& operator=(const JournalKeeper&) = delete;
    ~JournalKeeper();

    /// A rectangle of the picture is in the film. From any thread.
    void tile_finished(const Rect& tile);

    /// It is there no longer; to be called before others may render it. From any thread.
    void tile_lost(const Rect& tile);

    /// Takes what is finished of the first pass out of the film: its pixels may change now.
    void first_pass_ended();

    /// Pixels of the film were refined in this pass.
    void refined(int pass, std::span<const std::int32_t> pixels);

    /// Ends the thread and writes what is left, if it was worth writing before.
    void close();

    /// As close, and notes that all is there.
    void close_finished();

    /// Ends the thread; what is left need not be kept.
    void stop();

   private:
    void have_thread();
    void keep();
    bool is_time() const { return watch_.seconds() >= delay_; }
    void take_tiles();
    void write();

    JournalFile& file_;
    const Film<T>& film_;
    const Rect shown_;
    const double delay_;
    const Stopwatch watch_;
    std::mutex mutex_;         ///< of what follows
    std::vector<Rect> tiles_;  ///< finished, not taken yet
    std::vector<std::byte> records_;
    std::size_t bare_bytes_;  ///< of records that say nothing yet
    bool is_stopped_ = false;
    std::condition_variable stopped_;
    std::mutex write_mutex_;  ///< one write at a time, in order
    std::thread thread_;
    bool has_thread_ = false;  ///< or could have none: all is written at the end
};

}  // namespace rt
