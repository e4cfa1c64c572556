// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/base/hash.h"
#include "host/base/text.h"
#include "host/flatten/flat_scene.h"
#include "host/image/image_error.h"
#include "host/render/estimate.h"
#include "host/render/picture_spec.h"
#include "host/render/renderer.h"

// What a rendering reports: its structs, each with its fields' names in JSON (host/record).
namespace rt {

/// Who rendered.
struct DeviceStats {
    std::string name;      ///< "threads" or the OpenCL device's name
    std::string platform;  ///< OpenCL platform; empty for threads
    std::string driver;
    std::string launch;         ///< "pixel" or "sample" work items; empty for threads
    int lanes = 0;              ///< rays of a packet
    std::string isa;            ///< of the threads' kernels: x86-64-v4; empty for OpenCL
    std::string schedule;       ///< "tiles" or "buffers"; empty for OpenCL
    int threads = 0;            ///< of the pthreads renderer; 0 for OpenCL
    std::string fallback_from;  ///< the device that failed before; empty when none did
    Features kernels;           ///< compiled into its kernels; none for several devices
};

template <typename A, Of<DeviceStats> X>
void describe(A& a, X& x) {
    const bool is_opencl = !x.platform.empty();
    a("name", x.name, "\"threads\", or the OpenCL device's name");
    a("platform", unless_empty(x.platform), "of OpenCL");
    a("driver", is_opencl ? std::optional(x.driver) : std::nullopt, "its version");
    a("launch", is_opencl ? std::optional(x.launch) : std::nullopt, "what a work item renders");
    a("threads", is_opencl ? std::nullopt : std::optional(x.threads), "of the pthreads renderer");
    a("schedule", is_opencl ? std::nullopt : std::optional(x.schedule), "tiles or buffers");
    a("lanes", x.lanes, "rays of a packet");
    a("isa", unless_empty(x.isa), "instruction set of the threads' kernels");
    a("fallback_from", unless_empty(x.fallback_from), "the device that failed before");
}

/// What one of several devices did, or a device that failed.
struct DeviceShare {
    std::string name;
    std::int64_t pixels = 0;  ///< rendered
    double ready = 0;         ///< seconds to open and compile, until it could begin; 0: never
    std::string failure;      ///< empty when it did not fail
};

template <typename A, Of<DeviceShare> X>
void describe(A& a, X& x) {
    a("name", x.name, "of the device");
    a("pixels", x.pixels, "rendered");
    a("ready", or_null(x.ready > 0 ? std::optional(x.ready) : std::nullopt),
      "seconds until it could begin; null: never");
    a("failure", unless_empty(x.failure), "how it failed");
}

/// Which scene.
struct SceneId {
    std::string path, name;
    std::uint64_t hash = 0;
};

template <typename A, Of<SceneId> X>
void describe(A& a, X& x) {
    a("path", printable(x.path), "of its file");
    a("name", x.name, "");
    a("hash", hash_text(x.hash), "of what it says");
}

/// What was rendered.
struct SceneStats : SceneId {
    std::size_t smooth_triangles = 0, lights = 0, materials = 0;
    std::size_t bytes = 0;  ///< flattened
    FlattenStats flatten;
    Features features;  ///< what it needs of the kernels
    Features compiled;  ///< that, and what was compiled in although it is not needed
};

template <typename A, Of<KindStats> X>
void describe(A& a, X& x) {
    a("over", x.many, "a kind of primitive");
    a("nodes", x.hierarchy.nodes, "");
    a("leaves", x.hierarchy.leaves, "");
    a("depth", x.hierarchy.depth, "levels");
    a("sah_cost", x.hierarchy.sah_cost, "by the surface area heuristic");
}

/// The kinds that have a hierarchy.
inline std::vector<KindStats> hierarchies_of(const FlattenStats& stats) {
    std::vector<KindStats> list;
    for (const KindStats& kind : stats.kinds()) {
        if (kind.hierarchy.nodes > 0) list.push_back(kind);
    }
    return list;
}

template <typename A, Of<SceneStats> X>
void describe(A& a, X& x) {
    const SceneId& id = x;
    describe(a, id);
    for (const KindStats& kind : x.flatten.kinds()) {
        a(kind.many, kind.count, "");
    }
    a("smooth_triangles", x.smooth_triangles, "those with vertex normals");
    a("lights", x.lights, "");
    a("materials", x.materials, "");
    a("flat_bytes", x.bytes, "of the arrays that renderers read");
    a("hierarchies", hierarchies_of(x.flatten), "bounding volume hierarchies");
    a("hierarchy_seconds", x.flatten.bvh_seconds, "to build them");
    a("shadow_casters", x.flatten.casters, "pairs of a light and a triangle that may shadow it");
    a("lit_triangles", x.flatten.lit_triangles, "all pairs of a light and a triangle");
    a("features_used", names_of(x.features, true), "what the scene needs of the kernels");
    a("features_left_out", names_of(x.compiled, false), "what was not compiled in");
}

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

template <typename A, Of<PhaseStats> X>
void describe(A& a, X& x) {
    a("start", x.start, "seconds before main");
    a("load", x.load, "seconds to read the scene");
    a("flatten", x.flatten, "seconds to make the renderers' arrays");
    a("open", x.renderer.open, "seconds to find and open the device");
    a("build", x.renderer.build, "seconds to compile or load the kernels");
    a("upload", x.renderer.upload, "seconds to copy the scene to the device");
    a("self_test", x.renderer.check, "seconds of the device's self-test");
    a("trace", x.renderer.trace, "seconds from the first ray to the last");
    a("kernel", x.renderer.kernel, "seconds of that in kernels, by the device's own clock");
    a("resolve", x.renderer.resolve, "seconds to average sample buffers");
    a("read_back", x.renderer.read_back, "seconds to copy the film to the host");
    a("write", x.write, "seconds to write the picture");
    a("total", x.total, "seconds");
    a("set_up", x.set_up(), "seconds before trace, as in the paper");
    a("resolve_and_write", x.resolve_and_write(), "seconds after trace");
}

/// One rendering, as data: what --stats prints and the benchmarks collect.
struct RenderStats {
    SceneStats scene;
    PictureSpec picture;
    KernelChoice kernels;             ///< requested
    std::optional<bool> hierarchies;  ///< requested; empty: where they are faster
    bool caster_lists = true;
    DeviceStats device;
    std::vector<DeviceShare> shares;  ///< of each device, those that failed included
    PhaseStats phases;
    RayCounts rays;
    std::size_t tiles = 0, tiles_finished = 0;
    double resumed = 0;             ///< share of the film's pixels that a journal had, 0 to 1
    std::size_t tiles_checked = 0;  ///< traced again on threads
    std::uint64_t image_hash = 0;
    std::size_t non_finite = 0;  ///< pixels
    std::optional<ErrorEstimate> estimate;
    std::optional<ImageError> error;

    /// Rays per second while tracing; 0 when nothing was traced.
    double rays_per_second() const {
        const double seconds = phases.renderer.trace;
        return seconds > 0 ? static_cast<double>(rays.total()) / seconds : 0;
    }

    bool complete() const { return tiles_finished == tiles; }

    /// How the first device that failed did; empty if none did.
    std::string failure() const {
        for (const DeviceShare& share : shares) {
            if (!share.failure.empty()) return share.failure;
        }
        return "";
    }

    /// Notes a device that failed before others began the picture.
    void note_failed(const std::string& name, const std::string& how) {
        device.fallback_from = name;
        shares.insert(shares.begin(), {name, 0, 0, how});
    }
};

/// What the runs of a benchmark repeat of RenderStats.
template <typename A, typename X>
void describe_run(A& a, X& x) {
    a.group("settings", [&](auto& inner) {
        describe(inner, x.picture);
        const Features added = x.kernels.features.all() ? Features() : x.kernels.features;
        inner("features", std::string(x.kernels.features.all() ? "all" : "auto"),
              "what is compiled: what the scene needs, or everything");
        inner("features_added", names_of(added, true), "compiled although not needed");
        inner("hierarchies",
              std::string(!x.hierarchies   ? "auto"
                          : *x.hierarchies ? "on"
                                           : "off"),
              "requested");
        inner("caster_lists", std::string(x.caster_lists ? "on" : "off"), "requested");
    });
    a("device", x.device, "who rendered");
    a("seconds", x.phases, "wall-clock time by phase");
    a("rays", x.rays, "traced, by kind");
    a("rays_per_second", x.rays_per_second(), "while tracing");
    a.group("image", [&](auto& inner) {
        inner("hash", hash_text(x.image_hash), "of every bit of the picture");
        inner("non_finite", x.non_finite, "pixels with a NaN or an infinity");
    });
    a("estimate", x.estimate, "of the picture's error, without a reference");
}

template <typename A, Of<RenderStats> X>
void describe(A& a, X& x) {
    const auto if_positive = [](auto n) { return n > 0 ? std::optional(n) : std::nullopt; };
    a("scene", x.scene, "what was rendered");
    describe_run(a, x);
    a("complete", x.complete(), "false if it was stopped early");
    a("devices", x.shares.size() > 1 ? std::optional(x.shares) : std::nullopt,
      "what each of several devices did");
    a("resumed", if_positive(x.resumed), "share of the pixels that a journal had, 0 to 1");
    a("tiles_checked", if_positive(x.tiles_checked), "traced again on threads");
    a("error", x.error, "relative to --reference");
}

}  // namespace rt
