// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "host/base/error.h"
#include "host/base/parallel.h"
#include "host/flatten/flat_scene.h"
#include "host/opencl/cl_renderer.h"
#include "host/opencl/devices.h"
#include "host/picture/render_picture.h"
#include "host/picture/render_settings.h"
#include "host/picture/render_stats.h"
#include "host/render/renderer.h"
#include "host/render/threads_renderer.h"

// The devices that render a picture: who they are, their renderers, whether what they do is right,
// and what is kept for the next.
namespace rt {

/// A renderer that may not have been created yet.
template <typename T>
struct CrewMember {
    std::string name;  ///< of the device, for messages
    TileSizes tiles;
    std::function<std::unique_ptr<Renderer<T>>()> make;  ///< opens and compiles; throws Error
    std::function<void(Renderer<T>&)> test;              ///< throws Error if results are wrong
    std::string failure = {};                            ///< why it cannot be created, if known
    DeviceStats stats = {};
};

/// The renderers of one picture. A single one renders on the caller's thread. Several take tiles
/// from the same queue, each on its own thread as soon as it is created; those still compiling
/// delay nobody. One that fails is left out.
template <typename T>
class Crew : public Renderer<T> {
   public:
    using Warn = std::function<void(const std::string& line)>;

    Crew(std::vector<CrewMember<T>> members, Warn warn)
        : shared_(std::make_shared<Shared>()),
          warn_(std::move(warn)),
          is_single_(members.size() == 1) {
        for (CrewMember<T>& member : members) {
            shared_->slots.emplace_back().member = std::move(member);
        }
    }

    /// Does not wait for members still being created.
    ~Crew() override {
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

    /// Creates a single member; starts creating several. Throws like render.
    void open() {
        std::unique_lock lock(shared_->mutex);
        for (Slot& slot : shared_->slots) start(slot, lock);
        note_failed();
    }

    /// Tiles that suit every member.
    TileSizes tile_sizes(int film_width) const override {
        TileSizes sizes = shared_->slots.front().member.tiles;
        for (const Slot& slot : shared_->slots) {
            const auto& [best, most_pixels] = slot.member.tiles;
            if (best.pixels() < sizes.best.pixels()) sizes.best = best;
            sizes.most_pixels = std::min(sizes.most_pixels, most_pixels);
        }
        sizes.best.width = std::min(sizes.best.width, film_width);
        return sizes;
    }

    /// Throws Error when the last member fails.
    void render(TileQueue& queue, const Rect& region, Film<T>& film) override {
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
                // Nobody notifies it of a stop while no member is working.
                shared.changed.wait_for(lock, std::chrono::milliseconds(50));
            }
        }
        shared.queue = nullptr;
        trace_seconds_ += watch.seconds();
    }

    RendererTimes times() const override {
        const std::scoped_lock lock(shared_->mutex);
        const Slot& last = shared_->slots.back();
        RendererTimes times;
        if (is_single_ && last.renderer) times = last.times();
        times.check = last.check;
        if (!is_single_) times.trace = trace_seconds_;
        return times;
    }

    /// The first member.
    DeviceStats stats() const { return shared_->slots.front().member.stats; }

    /// What each has done so far, in the given order.
    std::vector<DeviceShare> shares() const {
        const std::scoped_lock lock(shared_->mutex);
        std::vector<DeviceShare> shares;
        for (const Slot& slot : shared_->slots) {
            DeviceShare& share = shares.emplace_back();
            share.name = slot.member.name;
            share.ready = slot.ready;
            if (slot.renderer) share.pixels = slot.times().pixels;
            if (slot.failure) share.failure = message_of(slot.failure);
        }
        return shares;
    }

   private:
    /// A member and its state.
    struct Slot {
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

        /// Without those of its test.
        RendererTimes times() const {
            RendererTimes times = renderer->times();
            times.trace -= before.trace;
            times.kernel -= before.kernel;
            times.resolve -= before.resolve;
            times.read_back -= before.read_back;
            times.pixels -= before.pixels;
            return times;
        }
    };

    /// What the members' threads share. `mutex` guards all of it.
    struct Shared {
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
        void fail(Slot& slot, const std::exception_ptr& failure) {
            slot.failure = last_failure = failure;
            changed.notify_all();
        }
    };

    static std::string message_of(std::exception_ptr failure) {
        try {
            std::rethrow_exception(std::move(failure));
        } catch (const std::exception& error) {
            return error.what();
        }
    }

    /// Creates and tests a member's renderer; the mutex is not held.
    static void make(Shared& shared, Slot& slot) try {
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
    static void take_part(Shared& shared, Slot& slot, std::unique_lock<std::mutex>& lock) {
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
    static void serve(const std::shared_ptr<Shared>& shared, Slot& slot) {
        make(*shared, slot);
        std::unique_lock lock(shared->mutex);
        while (slot.failure == nullptr) {
            shared->changed.wait(lock, [&] { return shared->is_closed || shared->has_work(slot); });
            if (shared->is_closed) return;
            take_part(*shared, slot, lock);
        }
    }

    /// Starts a member's thread, or creates a single one.
    void start(Slot& slot, std::unique_lock<std::mutex>& lock) {
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

    /// Warns of members that failed; when none is left, rethrows the last failure. Requires the
    /// mutex.
    void note_failed() {
        const bool is_any_left = std::ranges::count(shared_->slots, nullptr, &Slot::failure) > 0;
        for (Slot& slot : shared_->slots) {
            if (slot.failure == nullptr || std::exchange(slot.has_warned, true)) continue;
            if (!is_any_left && slot.failure == shared_->last_failure) continue;
            warn_(message_of(slot.failure) + "; continuing without it");
        }
        if (!is_any_left) std::rethrow_exception(shared_->last_failure);
    }

    std::shared_ptr<Shared> shared_;  ///< also held by the members' threads
    Warn warn_;
    const bool is_single_;
    double trace_seconds_ = 0;
};

/// A scene ready to render, shared by all its renderers.
template <typename T>
using SharedScene = std::shared_ptr<const FlatScene<T>>;

/// What is kept between pictures with the same settings: open devices and their programs.
struct RenderCache {
    std::shared_ptr<OpenDevices> devices = make_open_devices();
    bool has_warned = false;  ///< of what users should know of devices and settings
};

/// "threads + NVIDIA H100".
std::string joined_names(const std::vector<DeviceChoice>& devices);

/// The names of devices whose bits may differ from the others'; "" if there are none.
std::string inexact_names(const std::vector<DeviceChoice>& devices, Precision precision);

/// Warns of settings that do not apply to the device and would be dropped silently.
void warn_of_ignored_settings(const DeviceChoice& choice, const RenderSettings& settings,
                              const AaMode& aa, const RenderEvents& events);

/// Makes the renderers of a scene, and describes them for figures.
template <typename T>
struct CrewMaker {
    /// A member for each device. An OpenCL device is opened (or reused), compiled and uploaded to,
    /// and tested by self_test; one that its driver could not list fails.
    std::vector<CrewMember<T>> members(const std::vector<DeviceChoice>& devices) const;

    SharedScene<T> scene;
    const RenderSettings& settings;
    AaMode aa;
    std::shared_ptr<OpenDevices> open;  ///< devices to reuse
    std::function<void()> loaded;  ///< called when a driver was loaded, which may have replaced
                                   ///< signal handlers

    CrewMember<T> threads_member(const ThreadsOptions& options) const;
    CrewMember<T> device_member(const ClDevice& device, bool is_alone) const;
};

/// Renders four strips across the picture on the device and on threads. Throws Error
/// (ExitCode::device) unless the bits and the counts of rays are the same: the driver, or the
/// kernel it keeps in its cache, is broken. Strict arithmetic only. About 33,000 samples, a
/// millisecond or two.
template <typename T>
void self_test(Renderer<T>& renderer, const ClDevice& device, const FlatScene<T>& scene,
               const std::string& isa);

/// The result of tracing part of a finished picture again on threads.
struct TileCheck {
    std::size_t tiles = 0;
    std::size_t wrong_tiles = 0;  ///< with different bits
};

/// Traces `share` (0 to 1) of the tiles again, at least one, spread over the region that the film
/// shows, and other ones each time, until stopped; the tiles lie in it.
template <typename T>
TileCheck check_tiles(const FlatScene<T>& scene, const std::string& isa,
                      const std::vector<Rect>& tiles, double share, const Rect& region,
                      const Film<T>& film, const StopFlag& stop);

}  // namespace rt
