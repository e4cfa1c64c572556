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
#include "host/picture/pixel_runs.h"
#include "host/render/stopwatch.h"

namespace rt {

namespace {

/// Pixels that each of several members refines at a time.
constexpr std::size_t refine_run = 4096;

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
struct Crew<T>::Place {
    CrewMember<T> member;
    std::unique_ptr<Renderer<T>> renderer;
    RendererTimes before;        ///< up to the end of its test
    double check = 0;            ///< seconds of the test
    double ready = 0;            ///< seconds until it could begin
    std::exception_ptr failure;  ///< why it does not render
    bool failure_is_told = false;
    int last_round = 0;  ///< of jobs: the last one it took part in
    std::thread thread;

    bool is_able() const { return renderer != nullptr && failure == nullptr; }
    bool is_in_the_making() const { return renderer == nullptr && failure == nullptr; }
};

/// What the members' threads share. `mutex` guards all of it.
template <typename T>
struct Crew<T>::Team {
    std::mutex mutex;
    std::condition_variable changed;
    std::deque<Place> places;
    const Job* job = nullptr;
    int round = 0;    ///< of jobs; each member takes part in one once
    int working = 0;  ///< members at work
    bool is_closed = false;
    const Stopwatch watch;

    bool has_work(const Place& place) const {
        return job != nullptr && place.is_able() && place.last_round != round;
    }
    template <typename Test>
    bool any(const Test& test) const {
        return std::any_of(places.begin(), places.end(), test);
    }
    bool has_several() const {
        return places.size() > 1 && any([](const Place& place) {
                   return place.thread.joinable() && place.failure == nullptr;
               });
    }
};

template <typename T>
Crew<T>::Crew(std::vector<CrewMember<T>> members, std::optional<CrewMember<T>> spare, Say say)
    : team_(std::make_shared<Team>()), spare_(std::move(spare)), say_(std::move(say)) {
    for (CrewMember<T>& member : members) {
        Place& place = team_->places.emplace_back();
        place.member = std::move(member);
        if (place.member.failure.empty()) continue;
        place.failure = std::make_exception_ptr(Error(ExitCode::device, place.member.failure));
    }
}

template <typename T>
Crew<T>::~Crew() {
    std::unique_lock lock(team_->mutex);
    team_->is_closed = true;
    team_->changed.notify_all();
    for (Place& place : team_->places) {
        if (!place.thread.joinable()) continue;
        if (place.is_in_the_making()) {
            place.thread.detach();
            continue;
        }
        lock.unlock();
        place.thread.join();
        lock.lock();
    }
}

template <typename T>
void Crew<T>::make(Place& place) {
    if (place.failure) std::rethrow_exception(place.failure);
    auto renderer = place.member.make();
    const Stopwatch watch;
    if (place.member.test) place.member.test(*renderer);
    place.check = watch.seconds();
    place.before = renderer->times();
    place.ready = team_->watch.seconds();
    place.renderer = std::move(renderer);
}

template <typename T>
void Crew<T>::open() {
    if (team_->places.size() == 1) {
        Place& place = team_->places.front();
        try {
            make(place);
        } catch (const Error&) {
            replace(place, std::current_exception());
        }
        return;
    }
    {
        const std::scoped_lock lock(team_->mutex);
        for (Place& place : team_->places) {
            if (place.failure) continue;
            place.thread = std::thread([team = team_, &place] { serve(team, place); });
        }
        if (team_->any([](const Place& place) { return place.failure == nullptr; })) return;
    }
    replace(team_->places.back(), team_->places.back().failure);
}

/// A member's thread, which may outlive the crew if the member is still being created.
template <typename T>
void Crew<T>::serve(const std::shared_ptr<Team>& team, Place& place) {
    const auto fail = [&] {
        const std::scoped_lock lock(team->mutex);
        place.failure = std::current_exception();
        team->changed.notify_all();
    };
    Place made;
    const auto make = [&] {
        made.renderer = place.member.make();
        const Stopwatch watch;
        if (place.member.test) place.member.test(*made.renderer);
        made.check = watch.seconds();
        made.before = made.renderer->times();
    };
    try {
        make();
    } catch (...) {
        return fail();
    }
    std::unique_lock lock(team->mutex);
    place.renderer = std::move(made.renderer);
    place.before = made.before;
    place.check = made.check;
    place.ready = team->watch.seconds();
    team->changed.notify_all();
    for (;;) {
        team->changed.wait(lock, [&] { return team->is_closed || team->has_work(place); });
        if (team->is_closed) return;
        place.last_round = team->round;
        ++team->working;
        const Job& job = *team->job;
        lock.unlock();
        std::exception_ptr failure;
        try {
            job(*place.renderer);
        } catch (...) {
            failure = std::current_exception();
        }
        lock.lock();
        --team->working;
        place.failure = failure;
        team->changed.notify_all();
        if (failure != nullptr) return;
    }
}

/// When the only or last member fails: switches to the spare, or rethrows the failure.
template <typename T>
void Crew<T>::replace(Place& place, std::exception_ptr failure) {
    place.failure = failure;
    place.failure_is_told = true;
    if (!spare_ || !is_of_device(failure)) std::rethrow_exception(failure);
    say_(message_of(failure));
    say_("rendering on threads instead");
    team_->places.emplace_back().member = *std::move(spare_);
    spare_.reset();
    uses_spare_ = true;
    make(team_->places.back());
}

template <typename T>
void Crew<T>::work_alone(const Job& job) {
    for (;;) {
        Place& place = team_->places.back();
        try {
            return job(*place.renderer);
        } catch (const Error&) {
            replace(place, std::current_exception());
        }
    }
}

template <typename T>
void Crew<T>::work_together(const Job& job, const std::function<bool()>& is_unfinished) {
    Team& team = *team_;
    const Stopwatch watch;
    std::unique_lock lock(team.mutex);
    team.job = &job;
    ++team.round;
    team.changed.notify_all();
    for (;;) {
        for (Place& place : team.places) {
            if (place.failure == nullptr || std::exchange(place.failure_is_told, true)) continue;
            say_(message_of(place.failure) + "; continuing without it");
        }
        const bool is_idle = team.working == 0 &&
                             !team.any([&](const Place& place) { return team.has_work(place); });
        if (is_idle) {
            if (!is_unfinished()) break;
            if (team.any([](const Place& place) { return place.is_able(); })) {
                ++team.round;  // one failed and gave tiles back after the others were done
                team.changed.notify_all();
            } else if (!team.any([](const Place& place) { return place.is_in_the_making(); })) {
                break;
            }
        }
        team.changed.wait_for(lock, stop_interval);
    }
    team.job = nullptr;
    trace_seconds_ += watch.seconds();
}

template <typename T>
void Crew<T>::work(const Job& job, const std::function<bool()>& is_unfinished) {
    const auto several = [&] {
        const std::scoped_lock lock(team_->mutex);
        return team_->has_several();
    };
    if (several()) {
        work_together(job, is_unfinished);
        if (several() || !is_unfinished()) return;
        replace(team_->places.back(), team_->places.back().failure);
    }
    work_alone(job);
}

template <typename T>
Rect Crew<T>::tile_size(int film_width) const {
    Rect smallest = team_->places.front().member.tile;
    for (const Place& place : team_->places) {
        const Rect& tile = place.member.tile;
        if (tile.pixels() < smallest.pixels()) smallest = tile;
    }
    smallest.width = std::min(smallest.width, film_width);
    return smallest;
}

template <typename T>
std::int64_t Crew<T>::most_tile_pixels() const {
    std::int64_t most = std::numeric_limits<int>::max();
    for (const Place& place : team_->places) most = std::min(most, place.member.most_tile_pixels);
    return most;
}

template <typename T>
void Crew<T>::render(TileQueue& queue, const Rect& region, Film<T>& film) {
    work([&](Renderer<T>& renderer) { renderer.render(queue, region, film); },
         [&] { return !queue.stopped() && queue.tiles_finished() < queue.tiles().size(); });
}

template <typename T>
void Crew<T>::refine(std::span<const std::int32_t> pixels, int grid, TileQueue& queue,
                     const Rect& region, Film<T>& film) {
    PixelRuns runs(pixels, team_->places.size() > 1 ? refine_run : pixels.size());
    const auto refine_runs = [&](Renderer<T>& renderer) {
        while (const auto run = runs.take()) {
            try {
                renderer.refine(*run, grid, queue, region, film);
            } catch (...) {
                runs.give_back(*run);
                throw;
            }
        }
    };
    work(refine_runs, [&] { return !queue.stopped() && !runs.empty(); });
}

template <typename T>
RendererTimes Crew<T>::times() const {
    const std::scoped_lock lock(team_->mutex);
    const Place& last = team_->places.back();
    RendererTimes times;
    if (!last.thread.joinable() && last.renderer)
        times = without(last.renderer->times(), last.before);
    times.check = last.check;
    times.trace += trace_seconds_;
    return times;
}

template <typename T>
std::vector<DeviceShare> Crew<T>::shares() const {
    const std::scoped_lock lock(team_->mutex);
    std::vector<DeviceShare> shares;
    for (const Place& place : team_->places) {
        DeviceShare& share = shares.emplace_back();
        share.name = place.member.name;
        share.ready = place.ready;
        if (place.renderer) share.pixels = without(place.renderer->times(), place.before).pixels;
        if (place.failure) share.failure = message_of(place.failure);
    }
    return shares;
}

template class Crew<float>;
template class Crew<double>;

}  // namespace rt
