// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "host/journal/journal_file.h"
#include "host/render/film.h"
#include "host/render/stopwatch.h"

namespace rt {

/// Appends the finished parts of a film to its journal every second, on its own thread, started
/// after `delay` seconds: quicker renders write nothing.
template <typename T>
class JournalKeeper {
   public:
    /// `writer` identifies this process. The film covers `shown` and must outlive this. `failed` is
    /// called once if nothing more can be written, on the thread; if it throws Error, so do
    /// tile_finished and refined from then on, as when another process has created the file.
    JournalKeeper(JournalFile& file, const JournalWriterInfo& writer, const Film<T>& film,
                  const Rect& shown, double delay, std::function<void()> failed);
    JournalKeeper(const JournalKeeper&) = delete;
    JournalKeeper& operator=(const JournalKeeper&) = delete;
    ~JournalKeeper();

    /// Writes at once who this is.
    void claim();

    /// A rectangle of the picture is now in the film. Callable from any thread.
    void tile_finished(const Rect& tile);

    /// It is no longer; call before it may be rendered again. Callable from any thread.
    void tile_lost(const Rect& tile);

    /// Copies what the first pass finished out of the film, whose pixels may now change.
    void first_pass_ended();

    /// Pixels of the film were refined in this pass.
    void refined(int pass, std::span<const std::int32_t> pixels);

    /// Whether there is anything worth keeping.
    bool has_pixels() const { return has_pixels_; }

    /// Ends the thread and writes the rest, if `delay` has passed. Rethrows the thread's errors.
    void close();

    /// As close, and marks the journal as finished.
    void close_finished();

    /// Ends the thread and discards the rest. Rethrows the thread's errors.
    void discard();

   private:
    void stop();
    void check() const;
    void have_thread();
    void keep();
    bool is_time() const { return watch_.seconds() >= delay_; }
    void take_tiles();
    void write();

    JournalFile& file_;
    const Film<T>& film_;
    const Rect shown_;
    const double delay_;
    const std::function<void()> failed_;
    const Stopwatch watch_;
    std::mutex mutex_;         ///< guards what follows
    std::vector<Rect> tiles_;  ///< finished, not yet copied
    std::vector<std::byte> records_;
    std::size_t bare_bytes_;      ///< size of records_ while it holds only the writer
    bool has_pixels_ = false;     ///< it ever had more
    std::exception_ptr failure_;  ///< Error that ends the render
    bool is_stopped_ = false;
    std::condition_variable stopped_;
    std::mutex write_mutex_;  ///< serializes writes
    std::thread thread_;
    bool has_thread_ = false;  ///< or failed to start it: close() then writes everything
};

}  // namespace rt
