// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "host/picture/render_stats.h"
#include "host/render/renderer.h"

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
/// delay nobody. One that fails is left out; when none is left the spare takes over.
template <typename T>
class Crew : public Renderer<T> {
   public:
    using Warn = std::function<void(const std::string& line)>;

    Crew(std::vector<CrewMember<T>> members, std::optional<CrewMember<T>> spare, Warn warn);
    ~Crew() override;  ///< does not wait for members still being created

    /// Creates a single member; starts creating several. Throws like render.
    void open();

    /// Tiles that suit every member.
    TileSizes tile_sizes(int film_width) const override;

    /// Throws Error when the last member fails and there is no spare.
    void render(TileQueue& queue, const Rect& region, Film<T>& film) override;

    RendererTimes times() const override;

    /// Whether the spare had to take over.
    bool uses_spare() const { return uses_spare_; }

    /// The only member, or the spare that took over.
    DeviceStats stats() const;

    /// What each has done so far, in the given order, the spare last.
    std::vector<DeviceShare> shares() const;

   private:
    struct Slot;    ///< a member and its state
    struct Shared;  ///< what the members' threads share

    static void make(Shared& shared, Slot& slot);
    static void take_part(Shared& shared, Slot& slot, std::unique_lock<std::mutex>& lock);
    static void serve(const std::shared_ptr<Shared>& shared, Slot& slot);
    void start(Slot& slot, std::unique_lock<std::mutex>& lock);
    void replace_failed(std::unique_lock<std::mutex>& lock);

    std::shared_ptr<Shared> shared_;  ///< also held by the members' threads
    std::optional<CrewMember<T>> spare_;
    Warn warn_;
    const bool is_single_;
    bool uses_spare_ = false;
    double trace_seconds_ = 0;
};

}  // namespace rt
