// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <new>
#include <span>
#include <stop_token>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "host/base/files.h"
#include "host/base/parallel.h"
#include "host/journal/journal_format.h"
#include "host/render/film.h"

namespace rt {

/// An on-disk journal that one process appends to while holding a lock on it (flock). It is created
/// with the first record. Failures to write are stored as a message, not thrown: rendering
/// continues without the journal.
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

    /// Replaces its contents on the next write, which begins with `start`.
    void restart(std::vector<std::byte> start);

    /// Whether the file exists and holds this picture.
    bool exists() const { return file_ && start_.empty(); }

    /// Appends whole records and flushes them to disk.
    void append(std::span<const std::byte> records);

    /// Removes the file, unless it holds another picture: restarted, and nothing written since.
    /// What is appended then creates it again.
    void remove();

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
    std::uint64_t end_ = 0;         ///< length of the good part
    std::vector<std::byte> start_;  ///< empty once it is written
};

/// Appends the finished parts of a film to its journal every second, on its own thread, started
/// after `delay` seconds: quicker renders write nothing.
template <typename T>
class JournalKeeper {
   public:
    /// The film covers `shown` and must outlive this. Creates the file at once if it `claims` it.
    JournalKeeper(JournalFile& file, const Film<T>& film, const Rect& shown, double delay,
                  bool claims)
        : file_(file), film_(film), shown_(shown), delay_(delay) {
        if (claims) file_.append({});
    }
    JournalKeeper(const JournalKeeper&) = delete;
    JournalKeeper& operator=(const JournalKeeper&) = delete;

    /// A rectangle of the picture is now in the film. Callable from any thread. False if the file
    /// has failed, to which nothing is written then.
    bool tile_finished(const Rect& tile) {
        const std::scoped_lock lock(mutex_);
        has_pixels_ = true;
        if (has_failed_) return false;
        tiles_.push_back(tile);
        if (has_thread_ || !is_time()) return true;
        has_thread_ = true;
        try {
            thread_ = std::jthread([this](const std::stop_token& stop) { keep(stop); });
        } catch (const std::system_error&) {
        }
        return true;
    }

    /// Whether there ever was anything worth keeping.
    bool has_pixels() const { return has_pixels_; }

    /// Ends the thread and writes the rest, if `delay` has passed, and whether the journal is
    /// finished. Without it, the rest is discarded.
    void close(bool is_finished) {
        thread_.request_stop();
        if (thread_.joinable()) thread_.join();
        if (is_time()) write(is_finished);
    }

   private:
    void keep(const std::stop_token& stop) {
        const auto is_over = [&stop] { return stop.stop_requested(); };
        std::unique_lock lock(mutex_);
        do {
            lock.unlock();
            try {
                write(false);
            } catch (const std::bad_alloc&) {
                file_.give_up("out of memory");
            }
            lock.lock();
            has_failed_ = !file_.failure().empty();
        } while (!has_failed_ && !stopped_.wait_for(lock, stop, std::chrono::seconds(1), is_over));
    }

    bool is_time() const { return watch_.seconds() >= delay_; }

    /// The thread calls it, and close() after that has ended.
    void write(bool is_last) {
        std::vector<Rect> tiles;
        {
            const std::scoped_lock lock(mutex_);
            if (tiles_.empty() && !is_last) return;
            tiles.swap(tiles_);
        }
        std::vector<std::byte> records, body;
        for (const Rect& tile : tiles) {
            const Film<T> part = part_of(film_, shown_, tile);
            const auto rect = std::as_bytes(std::span(&tile, 1));
            const auto values = std::as_bytes(std::span(part.rgb));
            body.assign(rect.begin(), rect.end());
            body.insert(body.end(), values.begin(), values.end());
            append_record(records, RecordKind::tile, body);
        }
        if (is_last) append_record(records, RecordKind::finished, {});
        file_.append(records);
    }

    JournalFile& file_;
    const Film<T>& film_;
    const Rect shown_;
    const double delay_;
    const Stopwatch watch_;
    std::mutex mutex_;         ///< guards what follows
    std::vector<Rect> tiles_;  ///< finished, not yet copied
    bool has_pixels_ = false;
    bool has_failed_ = false;  ///< the file has
    std::condition_variable_any stopped_;
    bool has_thread_ = false;  ///< or failed to start it: close() then writes everything
    std::jthread thread_;
};

}  // namespace rt
