// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/picture/render_stats.h"
#include "host/render/renderer.h"

namespace rt {

/// A renderer that may still have to be made.
template <typename T>
struct CrewMember {
    std::string name;  ///< of the device, for people
    Rect tile;         ///< as Renderer::tile_size
    std::int64_t most_tile_pixels;
    std::function<std::unique_ptr<Renderer<T>>()> make;  ///< opens and compiles; throws Error
    std::function<void(Renderer<T>&)> test;              ///< throws Error unless it is right
};

/// The renderers of one picture. One renders on the caller's thread. Several take tiles from the
/// same queue, each on a thread of its own as soon as it is made: those that are still compiling
/// hold nobody up. One that fails is left out; when none is left the spare takes over.
template <typename T>
class Crew : public Renderer<T> {
   public:
    using Say = std::function<void(const std::string& line)>;

    Crew(std::vector<CrewMember<T>> members, std::optional<CrewMember<T>> spare, Say say);
    ~Crew() override;  ///< does not wait for members that are still being made

    /// Makes a single member; has several begin. Throws like render.
    void open();

    Rect tile_size(int film_width) const override;
    std::int64_t most_tile_pixels() const override;

    /// Throws Error when the last member fails and there is no spare.
    void render(TileQueue& queue, const Rect& region, Film<T>& film) override;
    void refine(std::span<const std::int32_t> pixels, int grid, TileQueue& queue,
                const Rect& region, Film<T>& film) override;

    RendererTimes times() const override;

    /// Whether the spare had to take over.
    bool uses_spare() const { return uses_spare_; }

    /// What each has done so far, in the order they were given, the spare last.
    std::vector<DeviceShare> shares() const;

   private:
    struct Place;
    struct Team;
    using Job = std::function<void(Renderer<T>&)>;

    void work(const Job& job, const std::function<bool()>& is_unfinished);
    void work_together(const Job& job, const std::function<bool()>& is_unfinished);
    void work_alone(const Job& job);
    void make(Place& place);
    void replace(Place& place, std::exception_ptr failure);
    static void serve(const std::shared_ptr<Team>& team, Place& place);

    std::shared_ptr<Team> team_;  ///< also held by the members' threads
    std::optional<CrewMember<T>> spare_;
    Say say_;
    bool uses_spare_ = false;
    double trace_seconds_ = 0;  ///< of several
};

}  // namespace rt
