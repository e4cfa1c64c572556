// SPDX-License-Identifier: Apache-2.0
#include "host/picture/crew.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "host/base/error.h"
#include "host/base/parallel.h"

namespace rt {

namespace {

/// How often to check for a stop while no member is working.
constexpr std::chrono::milliseconds stop_interval{50};

std::string message_of(std::exception_ptr failure) {
    try {
        std::rethrow_exception(std::move(failure));
    } catch (const std::exception& error) {
        return error.what();
    }
}

RendererTimes without(RendererTimes times, const RendererTimes& before) {
    times.trace -= before.trace;
    times.kernel -= before.kernel;
    times.resolve -= before.resolve;
    times.read_back -= before.read_back;
    times.pixels -= before.pixels;
    return times;
}

}  // namespace

/// A member and its state.
template <typename T>
struct Crew<T>::Slot {
    CrewMember<T> member;
    std::unique_ptr<Renderer<T>> renderer;
    RendererTimes before;        ///< up to the end of its test
    double check = 0;            ///< seconds of the test
    double ready = 0;            ///< seconds until it could begin
    std::exception_ptr failure;  ///< why it does not render
    bool has_warned = false;
    std::thread thread;

    bool is_able() const { return renderer != nullptr && failure == nullptr; }
    bool is_opening() const { return renderer == nullptr && failure == nullptr; }
};

/// What the members' threads share. `mutex` guards all of it.
template <typename T>
struct Crew<T>::Shared {
    std::mutex mutex;
    std::condition_variable changed;
    std::deque<Slot> slots;
    std::exception_ptr last_failure;
    const TileQueue* queue = nullptr;  ///< while rendering
    std::function<void(Renderer<T>&)> job;
    int working = 0;  ///< members at work
    bool is_closed = false;
    const Stopwatch watch;

    bool has_work(const Slot& slot) const {
        return slot.is_able() && queue != nullptr && queue->has_tiles();
    }
    template <typename Test>
    bool any(const Test& test) const {
        return std::any_of(slots.begin(), slots.end(), test);
    }
    bool any_left() const {
        return any([](const Slot& slot) { return slot.failure == nullptr; });
    }
    void fail(Slot& slot, const std::exception_ptr& failure) {
        slot.failure = last_failure = failure;
        changed.notify_all();
    }
};

template <typename T>
Crew<T>::Crew(std::vector<CrewMember<T>> members, Warn warn)
    : shared_(std::make_shared<Shared>()), warn_(std::move(warn)), is_single_(members.size() == 1) {
    for (CrewMember<T>& member : members) {
        shared_->slots.emplace_back().member = std::move(member);
    }
}

template <typename T>
Crew<T>::~Crew() {
    std::unique_lock lock(shared_->mutex);
    shared_->is_closed = true;
    shared_->changed.notify_all();
    for (Slot& slot : shared_->slots) {
        if (!slot.thread.joinable()) continue;
        if (slot.is_opening()) {
            slot.thread.detach();
            continue;
        }
        lock.unlock();
        slot.thread.join();
        lock.lock();
    }
}

/// Creates and tests a member's renderer; the mutex is not held.
template <typename T>
void Crew<T>::make(Shared& shared, Slot& slot) try {
    auto renderer = slot.member.make();
    const Stopwatch watch;
    if (slot.member.test) slot.member.test(*renderer);
    const double check = watch.seconds();
    const RendererTimes before = renderer->times();
    const std::scoped_lock lock(shared.mutex);
    slot.check = check;
    slot.before = before;
    slot.ready = shared.watch.seconds();
    slot.renderer = std::move(renderer);
    shared.changed.notify_all();
} catch (...) {
    const std::scoped_lock lock(shared.mutex);
    shared.fail(slot, std::current_exception());
}

/// Has a member render until no tile is left.
template <typename T>
void Crew<T>::take_part(Shared& shared, Slot& slot, std::unique_lock<std::mutex>& lock) {
    ++shared.working;
    lock.unlock();
    std::exception_ptr failure;
    try {
        shared.job(*slot.renderer);
    } catch (...) {
        failure = std::current_exception();
    }
    lock.lock();
    --shared.working;
    shared.changed.notify_all();
    if (failure != nullptr) shared.fail(slot, failure);
}

/// A member's thread, which may outlive the crew if the member is still being created.
template <typename T>
void Crew<T>::serve(const std::shared_ptr<Shared>& shared, Slot& slot) {
    make(*shared, slot);
    std::unique_lock lock(shared->mutex);
    while (slot.failure == nullptr) {
        shared->changed.wait(lock, [&] { return shared->is_closed || shared->has_work(slot); });
        if (shared->is_closed) return;
        take_part(*shared, slot, lock);
    }
}

/// Starts a member's thread, or creates a single one.
template <typename T>
void Crew<T>::start(Slot& slot, std::unique_lock<std::mutex>& lock) {
    if (!slot.member.failure.empty()) {
        const Error failure(ExitCode::device, slot.member.failure);
        shared_->fail(slot, std::make_exception_ptr(failure));
    } else if (is_single_) {
        lock.unlock();
        make(*shared_, slot);
        lock.lock();
    } else {
        slot.thread = std::thread([shared = shared_, &slot] { serve(shared, slot); });
    }
}

/// Warns of members that failed; when none is left, rethrows the last failure. Requires the mutex.
template <typename T>
void Crew<T>::note_failed() {
    const bool is_any_left = shared_->any_left();
    for (Slot& slot : shared_->slots) {
        if (slot.failure == nullptr || std::exchange(slot.has_warned, true)) continue;
        if (!is_any_left && slot.failure == shared_->last_failure) continue;
        warn_(message_of(slot.failure) + "; continuing without it");
    }
    if (!is_any_left) std::rethrow_exception(shared_->last_failure);
}

template <typename T>
void Crew<T>::open() {
    std::unique_lock lock(shared_->mutex);
    for (Slot& slot : shared_->slots) start(slot, lock);
    note_failed();
}

template <typename T>
void Crew<T>::render(TileQueue& queue, const Rect& region, Film<T>& film) {
    Shared& shared = *shared_;
    const Stopwatch watch;
    std::unique_lock lock(shared.mutex);
    shared.job = [&](Renderer<T>& renderer) { renderer.render(queue, region, film); };
    shared.queue = &queue;
    shared.changed.notify_all();
    for (;;) {
        note_failed();
        if (shared.working == 0 && !queue.has_tiles()) break;
        Slot& last = shared.slots.back();
        if (!last.thread.joinable() && shared.has_work(last)) {
            take_part(shared, last, lock);
        } else {
            shared.changed.wait_for(lock, stop_interval);
        }
    }
    shared.queue = nullptr;
    trace_seconds_ += watch.seconds();
}

template <typename T>
TileSizes Crew<T>::tile_sizes(int film_width) const {
    TileSizes sizes = shared_->slots.front().member.tiles;
    for (const Slot& slot : shared_->slots) {
        const auto& [best, most_pixels] = slot.member.tiles;
        if (best.pixels() < sizes.best.pixels()) sizes.best = best;
        sizes.most_pixels = std::min(sizes.most_pixels, most_pixels);
    }
    sizes.best.width = std::min(sizes.best.width, film_width);
    return sizes;
}

template <typename T>
RendererTimes Crew<T>::times() const {
    const std::scoped_lock lock(shared_->mutex);
    const Slot& last = shared_->slots.back();
    RendererTimes times;
    if (is_single_ && last.renderer) times = without(last.renderer->times(), last.before);
    times.check = last.check;
    if (!is_single_) times.trace = trace_seconds_;
    return times;
}

template <typename T>
DeviceStats Crew<T>::stats() const {
    return shared_->slots.front().member.stats;
}

template <typename T>
std::vector<DeviceShare> Crew<T>::shares() const {
    const std::scoped_lock lock(shared_->mutex);
    std::vector<DeviceShare> shares;
    for (const Slot& slot : shared_->slots) {
        DeviceShare& share = shares.emplace_back();
        share.name = slot.member.name;
        share.ready = slot.ready;
        if (slot.renderer) share.pixels = without(slot.renderer->times(), slot.before).pixels;
        if (slot.failure) share.failure = message_of(slot.failure);
    }
    return shares;
}

template class Crew<float>;
template class Crew<double>;

}  // namespace rt
