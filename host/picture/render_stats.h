// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/flatten/features.h"
#include "host/flatten/flat_scene.h"
#include "host/image/image_error.h"
#include "host/render/ray_counts.h"
#include "host/render/renderer.h"
#include "host/scene/aa_mode.h"

namespace rt {

/// Who rendered.
struct DeviceStats {
    std::string name;      ///< "threads" or the OpenCL device's name
    std::string platform;  ///< OpenCL platform; empty for threads
    std::string driver;
    std::string launch;                ///< "pixel" or "sample" work items; empty for threads
    int lanes = 0;                     ///< rays of a packet
    std::string isa;                   ///< of the threads' kernels: x86-64-v4; empty for OpenCL
    std::string schedule;              ///< "tiles" or "buffers"; empty for OpenCL
    int threads = 0;                   ///< of the pthreads renderer; 0 for OpenCL
    std::string fallback_from;         ///< the device that failed before; empty when none did
    Features kernels = no_features();  ///< compiled into its kernels; none for several devices
};

/// What one of several devices did, or a device that failed.
struct DeviceShare {
    std::string name;
    std::int64_t pixels = 0;  ///< rendered, not counting refined ones
    double ready = 0;         ///< seconds to open and compile, until it could begin; 0: never
    std::string failure;      ///< empty when it did not fail
};

/// What was rendered.
struct SceneStats {
    std::string path, name;
    std::uint64_t hash = 0;
    std::size_t spheres = 0, cones = 0, triangles = 0, smooth_triangles = 0, lights = 0,
                materials = 0;
    std::size_t bytes = 0;  ///< flattened
    FlattenStats flatten;
};

/// Wall-clock seconds. Set-up, as in the paper, is everything before `trace`; `resolve_and_write`
/// is everything after it.
struct PhaseStats {
    double start = 0;  ///< before main, from seconds_since_process_start
    double load = 0, flatten = 0;
    RendererTimes renderer;
    double write = 0;
    double total = 0;

    double set_up() const {
        return start + load + flatten + renderer.open + renderer.build + renderer.upload +
               renderer.check;
    }
    double resolve_and_write() const { return renderer.resolve + renderer.read_back + write; }
};

/// One rendering, as data: what --stats prints and the benchmarks collect.
struct RenderStats {
    SceneStats scene;
    DeviceStats device;
    std::vector<DeviceShare> shares;  ///< of each device, those that failed included
    PhaseStats phases;
    int width = 0, height = 0;  ///< of the whole picture
    Rect region;                ///< the part that was rendered
    AaMode aa;
    Filter filter = Filter::box;
    int max_bounces = 0;
    bool double_precision = false, fast_math = false;
    Features features;                       ///< what the scene needs
    bool all_features = false;               ///< compiled with everything anyway
    Features also_features = no_features();  ///< compiled anyway
    std::optional<bool> hierarchies;         ///< requested; empty: where they are faster
    bool caster_lists = true;
    RayCounts rays;
    std::size_t tiles = 0, tiles_finished = 0;
    double resumed = 0;             ///< share of the film's pixels that a journal had, 0 to 1
    std::size_t tiles_checked = 0;  ///< traced again on threads
    bool refined = true;            ///< false if stopped before an adaptive mode finished
    std::uint64_t image_hash = 0;
    std::size_t non_finite = 0;  ///< pixels
    std::optional<ImageError> error;
    std::optional<double> started;  ///< of a benchmark's runs: seconds since the first began

    /// Rays per second while tracing; 0 when nothing was traced.
    double rays_per_second() const;

    /// Whether kernels took less than half of the tracing time, by the device's clock: the driver
    /// spent the rest, usually compiling. Unknown, so false, for adaptive modes, which plan between
    /// kernels, and for short pictures.
    bool driver_took_its_time() const;

    bool complete() const { return refined && tiles_finished == tiles; }
};

/// Seconds since the system started this process: its processor time, if its one thread has not
/// waited; else up to 0.01 s too little, the resolution of the system's own record.
double seconds_since_process_start();

/// All that defines what was rendered except the scene, for picture metadata.
std::string settings_text(const RenderStats& stats);

/// 16 hexadecimal digits.
std::string hash_text(std::uint64_t hash);

}  // namespace rt
