// SPDX-License-Identifier: Apache-2.0
#include "host/journal/journal_keeper.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <new>
#include <system_error>
#include <utility>

#include "host/base/error.h"

namespace rt {

namespace {

constexpr std::chrono::seconds period{1};

std::array<std::int32_t, 4> numbers_of(const Rect& rect) {
    return {rect.x, rect.y, rect.width, rect.height};
}

}  // namespace

template <typename T>
JournalKeeper<T>::JournalKeeper(JournalFile& file, const JournalWriterInfo& writer,
                                const Film<T>& film, const Rect& shown, double delay,
                                std::function<void()> failed)
    : file_(file), film_(film), shown_(shown), delay_(delay), failed_(std::move(failed)) {
    append_writer(records_, writer);
    bare_bytes_ = records_.size();
}

template <typename T>
JournalKeeper<T>::~JournalKeeper() {
    stop();
}

/// Starts the thread when it is time. Requires the mutex.
template <typename T>
void JournalKeeper<T>::have_thread() {
    if (has_thread_ || is_stopped_ || !is_time()) return;
    has_thread_ = true;
    try {
        thread_ = std::thread([this] { keep(); });
    } catch (const std::system_error&) {
    }
}

template <typename T>
void JournalKeeper<T>::keep() {
    bool is_told = false;
    std::unique_lock lock(mutex_);
    while (!stopped_.wait_for(lock, period, [&] { return is_stopped_; })) {
        lock.unlock();
        std::exception_ptr failure;
        try {
            write();
            if (!file_.failure().empty() && !std::exchange(is_told, true)) failed_();
        } catch (const std::bad_alloc&) {
            file_.give_up("out of memory");
        } catch (const Error&) {
            failure = std::current_exception();
        }
        lock.lock();
        failure_ = failure;
        if (failure_) return;
    }
}

/// Requires the mutex, or that the thread has ended.
template <typename T>
void JournalKeeper<T>::check() const {
    if (failure_) std::rethrow_exception(failure_);
}

template <typename T>
void JournalKeeper<T>::claim() {
    bare_bytes_ = 0;
    write();
}

template <typename T>
void JournalKeeper<T>::tile_finished(const Rect& tile) {
    const std::scoped_lock lock(mutex_);
    check();
    has_pixels_ = true;
    tiles_.push_back(tile);
    have_thread();
}

template <typename T>
void JournalKeeper<T>::tile_lost(const Rect& tile) {
    const std::scoped_lock lock(mutex_);
    std::erase(tiles_, tile);
    const auto numbers = numbers_of(tile);
    append_record(records_, RecordKind::lost, std::as_bytes(std::span(numbers)));
}

/// Makes records of the finished tiles; the mutex is held.
template <typename T>
void JournalKeeper<T>::take_tiles() {
    std::vector<std::byte> body;
    for (const Rect& tile : tiles_) {
        const auto numbers = numbers_of(tile);
        const std::size_t row_bytes = 3 * sizeof(T) * static_cast<std::size_t>(tile.width);
        body.resize(sizeof(numbers) + row_bytes * static_cast<std::size_t>(tile.height));
        std::memcpy(body.data(), numbers.data(), sizeof(numbers));
        for (int row = 0; row < tile.height; ++row) {
            const std::size_t pixel = static_cast<std::size_t>(tile.y - shown_.y + row) *
                                          static_cast<std::size_t>(film_.width) +
                                      static_cast<std::size_t>(tile.x - shown_.x);
            std::memcpy(body.data() + sizeof(numbers) + static_cast<std::size_t>(row) * row_bytes,
                        &film_.rgb[3 * pixel], row_bytes);
        }
        append_record(records_, RecordKind::tile, body);
    }
    tiles_.clear();
}

template <typename T>
void JournalKeeper<T>::first_pass_ended() {
    const std::scoped_lock lock(mutex_);
    take_tiles();
}

template <typename T>
void JournalKeeper<T>::refined(int pass, std::span<const std::int32_t> pixels) {
    std::vector<std::byte> body(8 + pixels.size() * (4 + 3 * sizeof(T)));
    const std::uint32_t numbers[2] = {static_cast<std::uint32_t>(pass),
                                      static_cast<std::uint32_t>(pixels.size())};
    std::memcpy(body.data(), numbers, sizeof(numbers));
    std::memcpy(body.data() + 8, pixels.data(), pixels.size_bytes());
    std::byte* color = body.data() + 8 + pixels.size_bytes();
    for (const std::int32_t pixel : pixels) {
        std::memcpy(color, &film_.rgb[3 * static_cast<std::size_t>(pixel)], 3 * sizeof(T));
        color += 3 * sizeof(T);
    }
    const std::scoped_lock lock(mutex_);
    check();
    has_pixels_ = true;
    append_record(records_, RecordKind::refined, body);
    have_thread();
}

template <typename T>
void JournalKeeper<T>::write() {
    const std::scoped_lock one(write_mutex_);
    std::vector<std::byte> records;
    {
        const std::scoped_lock lock(mutex_);
        take_tiles();
        if (records_.size() == bare_bytes_) return;
        records.swap(records_);
        bare_bytes_ = 0;
    }
    file_.append(records);
}

template <typename T>
void JournalKeeper<T>::stop() {
    {
        const std::scoped_lock lock(mutex_);
        is_stopped_ = true;
        stopped_.notify_all();
    }
    if (thread_.joinable()) thread_.join();
}

template <typename T>
void JournalKeeper<T>::discard() {
    stop();
    check();
}

template <typename T>
void JournalKeeper<T>::close() {
    discard();
    if (is_time()) write();
}

template <typename T>
void JournalKeeper<T>::close_finished() {
    {
        const std::scoped_lock lock(mutex_);
        take_tiles();
        append_record(records_, RecordKind::finished, {});
    }
    close();
}

template class JournalKeeper<float>;
template class JournalKeeper<double>;

}  // namespace rt
