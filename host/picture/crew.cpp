// SPDX-License-Identifier: Apache-2.0
#include "host/picture/crew.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <limits>
#include <mutex>
#include <thread>
#include <utility>

#include "host/base/error.h"
#include "host/render/stopwatch.h"

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

/// Whether the device failed, rather than our caller.
bool is_of_device(const std::exception_ptr& failure) {
    try {
        std::rethrow_exception(failure);
    } catch (const Error& error) {
        return error.exit_code() == ExitCode::device;
    } catch (...) {
        return false;
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
    int last_round = 0;  ///< of jobs: the last one it took part in
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
    const Job* job = nullptr;
    int round = 0;    ///< of jobs; each member takes part in one once
    int working = 0;  ///< members at work
    bool is_closed = false;
    const Stopwatch watch;

    bool has_work(const Slot& slot) const {
        return job != nullptr && slot.is_able() && slot.last_round != round;
    }
    template <typename Test>
    bool any(const Test& test) const {
        return std::any_of(slots.begin(), slots.end(), test);
    }
    bool has_several() const {
        return slots.size() > 1 && any([](const Slot& slot) {
                   return slot.thread.joinable() && slot.failure == nullptr;
               });
    }
};

template <typename T>
Crew<T>::Crew(std::vector<CrewMember<T>> members, std::optional<CrewMember<T>> spare, Warn warn)
    : shared_(std::make_shared<Shared>()), spare_(std::move(spare)), warn_(std::move(warn)) {
    for (CrewMember<T>& member : members) {
        Slot& slot = shared_->slots.emplace_back();
        slot.member = std::move(member);
        if (slot.member.failure.empty()) continue;
        slot.failure = std::make_exception_ptr(Error(ExitCode::device, slot.member.failure));
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
void Crew<T>::make(Shared& shared, Slot& slot) {
    if (slot.failure) std::rethrow_exception(slot.failure);
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
}

template <typename T>
void Crew<T>::open() {
    if (shared_->slots.size() == 1) {
        Slot& slot = shared_->slots.front();
        try {
            make(*shared_, slot);
        } catch (const Error&) {
            replace(slot, std::current_exception());
        }
        return;
    }
    {
        const std::scoped_lock lock(shared_->mutex);
        for (Slot& slot : shared_->slots) {
            if (slot.failure) continue;
            slot.thread = std::thread([shared = shared_, &slot] { serve(shared, slot); });
        }
        if (shared_->any([](const Slot& slot) { return slot.failure == nullptr; })) return;
    }
    replace(shared_->slots.back(), shared_->slots.back().failure);
}

/// A member's thread, which may outlive the crew if the member is still being created.
template <typename T>
void Crew<T>::serve(const std::shared_ptr<Shared>& shared, Slot& slot) {
    try {
        make(*shared, slot);
    } catch (...) {
        const std::scoped_lock lock(shared->mutex);
        slot.failure = std::current_exception();
        shared->changed.notify_all();
        return;
    }
    std::unique_lock lock(shared->mutex);
    for (;;) {
        shared->changed.wait(lock, [&] { return shared->is_closed || shared->has_work(slot); });
        if (shared->is_closed) return;
        slot.last_round = shared->round;
        ++shared->working;
        const Job& job = *shared->job;
        lock.unlock();
        std::exception_ptr failure;
        try {
            job(*slot.renderer);
        } catch (...) {
            failure = std::current_exception();
        }
        lock.lock();
        --shared->working;
        slot.failure = failure;
        shared->changed.notify_all();
        if (failure != nullptr) return;
    }
}

/// When the only or last member fails: switches to the spare, or rethrows the failure.
template <typename T>
void Crew<T>::replace(Slot& slot, std::exception_ptr failure) {
    slot.failure = failure;
    slot.has_warned = true;
    if (!spare_ || !is_of_device(failure)) std::rethrow_exception(failure);
    warn_(message_of(failure));
    warn_("rendering on threads instead");
    shared_->slots.emplace_back().member = *std::move(spare_);
    spare_.reset();
    uses_spare_ = true;
    make(*shared_, shared_->slots.back());
}

template <typename T>
void Crew<T>::work_alone(const Job& job) {
    for (;;) {
        Slot& slot = shared_->slots.back();
        try {
            return job(*slot.renderer);
        } catch (const Error&) {
            replace(slot, std::current_exception());
        }
    }
}

template <typename T>
void Crew<T>::work_together(const Job& job, const std::function<bool()>& is_unfinished) {
    Shared& shared = *shared_;
    const Stopwatch watch;
    std::unique_lock lock(shared.mutex);
    shared.job = &job;
    ++shared.round;
    shared.changed.notify_all();
    for (;;) {
        for (Slot& slot : shared.slots) {
            if (slot.failure == nullptr || std::exchange(slot.has_warned, true)) continue;
            warn_(message_of(slot.failure) + "; continuing without it");
        }
        const bool is_idle = shared.working == 0 &&
                             !shared.any([&](const Slot& slot) { return shared.has_work(slot); });
        if (is_idle) {
            if (!is_unfinished()) break;
            if (shared.any([](const Slot& slot) { return slot.is_able(); })) {
                ++shared.round;  // one failed and gave tiles back after the others were done
                shared.changed.notify_all();
            } else if (!shared.any([](const Slot& slot) { return slot.is_opening(); })) {
                break;
            }
        }
        shared.changed.wait_for(lock, stop_interval);
    }
    shared.job = nullptr;
    trace_seconds_ += watch.seconds();
}

template <typename T>
void Crew<T>::work(const Job& job, const std::function<bool()>& is_unfinished) {
    const auto several = [&] {
        const std::scoped_lock lock(shared_->mutex);
        return shared_->has_several();
    };
    if (several()) {
        work_together(job, is_unfinished);
        if (several() || !is_unfinished()) return;
        replace(shared_->slots.back(), shared_->slots.back().failure);
    }
    work_alone(job);
}

template <typename T>
Rect Crew<T>::tile_size(int film_width) const {
    Rect smallest = shared_->slots.front().member.tile;
    for (const Slot& slot : shared_->slots) {
        const Rect& tile = slot.member.tile;
        if (tile.pixels() < smallest.pixels()) smallest = tile;
    }
    smallest.width = std::min(smallest.width, film_width);
    return smallest;
}

template <typename T>
std::int64_t Crew<T>::most_tile_pixels() const {
    std::int64_t most = std::numeric_limits<int>::max();
    for (const Slot& slot : shared_->slots) most = std::min(most, slot.member.most_tile_pixels);
    return most;
}

template <typename T>
void Crew<T>::render(TileQueue& queue, const Rect& region, Film<T>& film) {
    work([&](Renderer<T>& renderer) { renderer.render(queue, region, film); },
         [&] { return !queue.stopped() && queue.tiles_finished() < queue.tiles().size(); });
}

template <typename T>
RendererTimes Crew<T>::times() const {
    const std::scoped_lock lock(shared_->mutex);
    const Slot& last = shared_->slots.back();
    RendererTimes times;
    if (!last.thread.joinable() && last.renderer)
        times = without(last.renderer->times(), last.before);
    times.check = last.check;
    times.trace += trace_seconds_;
    return times;
}

template <typename T>
DeviceStats Crew<T>::stats() const {
    DeviceStats stats = shared_->slots.back().member.stats;
    if (uses_spare_) stats.fallback_from = shared_->slots.front().member.name;
    return stats;
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
