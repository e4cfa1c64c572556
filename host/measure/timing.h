// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/base/files.h"
#include "host/image/picture.h"
#include "host/measure/runs.h"
#include "host/opencl/device_spec.h"
#include "host/picture/render_picture.h"
#include "host/scene/scene.h"

namespace rt {

/// A scene as loaded; options override.
struct TimedScene {
    SceneId id;
    Scene scene;
    double load_seconds = 0;  ///< noted in every run
};

/// Loads a scene file, the built-in scene for "", and prints its notes unless `quiet`.
TimedScene load_timed_scene(const std::string& path, const LightOverrides& light, bool quiet);

/// One way to render one picture, to be timed, and the runs once it is.
struct TimedCase : TimedRuns {
    const TimedScene* scene = nullptr;
    const Picture* reference = nullptr;  ///< of the same size; errors are relative to it
    DeviceChoice device;
    RenderSettings settings;
    std::optional<std::uint64_t> expected_hash;  ///< of the picture, in strict arithmetic
};

/// The devices that specs name, without duplicates; "all" means threads and every usable OpenCL
/// device, with a line on stderr for each unusable one. Throws Error (usage or device) like
/// choose_device. OpenCL is not loaded if only threads are named.
std::vector<DeviceChoice> listed_devices(const std::vector<std::string>& specs);

/// The settings for a benchmark's renders, which fail if their device fails and are judged by the
/// benchmark itself.
RenderSettings timed_settings(RenderSettings settings = {});

/// Renders on the device silently, until a stop signal; the cache may be null.
RenderedPicture render_quietly(const Scene& scene, const RenderSettings& settings,
                               const DeviceChoice& device, RenderCache* cache = nullptr);

/// Renders every case once to warm up, then again `repeats` times; the rounds go over all cases (A
/// B A B), so that a slow moment of the machine hits all alike. Every picture is judged; a case
/// that is wrong or fails is not run again. A signal ends it after the pictures finished so far.
/// Prints a line on stderr for each round unless `quiet`. Returns whether it ran to the end.
bool run_rounds(std::vector<TimedCase>& cases, int repeats, bool quiet);

/// Warns on stderr, once and unless `quiet`, that the machine is busy with other work.
void say_busy(bool quiet);

/// An empty kernel cache for PoCL in its own folder, removed at the end: the first build of
/// each kernel is then cold and all others are warm, whatever ran before. Create it before OpenCL
/// starts. Has no effect if no folder can be made.
class FreshKernelCache {
   public:
    FreshKernelCache();

   private:
    TemporaryFolder folder_;
};

}  // namespace rt
