// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

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

    Crew(std::vector<CrewMember<T>> members, Warn warn);
    ~Crew() override;  ///< does not wait for members still being created

    /// Creates a single member; starts creating several. Throws like render.
    void open();

    /// Tiles that suit every member.
    TileSizes tile_sizes(int film_width) const override;

    /// Throws Error when the last member fails.
    void render(TileQueue& queue, const Rect& region, Film<T>& film) override;

    RendererTimes times() const override;

    /// The first member.
    DeviceStats stats() const;

    /// What each has done so far, in the given order.
    std::vector<DeviceShare> shares() const;

   private:
    struct Slot;    ///< a member and its state
    struct Shared;  ///< what the members' threads share

    static void make(Shared& shared, Slot& slot);
    static void take_part(Shared& shared, Slot& slot, std::unique_lock<std::mutex>& lock);
    static void serve(const std::shared_ptr<Shared>& shared, Slot& slot);
    void start(Slot& slot, std::unique_lock<std::mutex>& lock);
    void note_failed();

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
std::string inexact_names(const std::vector<DeviceChoice>& devices);

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
void self_test(Renderer<T>& device, const std::string& name, const FlatScene<T>& scene,
               const std::string& isa);

/// The result of tracing part of a finished picture again on threads.
struct TileCheck {
    std::size_t tiles = 0;
    std::size_t wrong_tiles = 0;  ///< with different bits
};

/// Traces `share` (0 to 1) of the tiles again, at least one, spread over the region that the film
/// shows, and other ones each time; the tiles lie in it.
template <typename T>
TileCheck check_tiles(const FlatScene<T>& scene, const std::string& isa,
                      const std::vector<Rect>& tiles, double share, const Rect& region,
                      const Film<T>& film);

}  // namespace rt
