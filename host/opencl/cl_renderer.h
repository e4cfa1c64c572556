// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "host/flatten/flat_scene.h"
#include "host/opencl/devices.h"
#include "host/render/picture_spec.h"
#include "host/render/renderer.h"

namespace rt {

/// kernels/render.cl with its includes, embedded at build time (cmake/embed_kernels.cpp).
extern const char* const render_kernels;

class OpenDevices;

/// Contexts and programs kept from picture to picture (opencl.h).
std::shared_ptr<OpenDevices> make_open_devices();

struct ClOptions {
    KernelChoice kernels{};
    Math math = Math::strict;
    bool shares_film = false;  ///< others render into the film at the same time
    std::shared_ptr<OpenDevices> open_devices = make_open_devices();
};

/// What is asked for with every build of this process.
struct BuildExtras {
    std::string options;  ///< further ones for the driver's compiler
    std::string folder;   ///< for each program's source, options, log and binary; empty: nowhere
};

BuildExtras& build_extras();

/// Whether a launch on this device has a work item per sample; never where pixels differ in
/// samples.
bool launches_samples(Launch launch, const ClDevice& device, bool in_rounds);

/// Rays per packet on this device: as requested, or (0) its native vector width on CPUs and one on
/// GPUs, which themselves run rays side by side.
template <typename T>
int packet_lanes(int asked_for, const ClDevice& device);

/// The most work items in one launch. PoCL compiles a kernel again when a grid exceeds 64 K items,
/// so CPU launches stay below; a GPU needs more to fill up.
std::size_t most_items(const ClDevice& device);

/// Renderer::tile_sizes of the renderer that make_cl_renderer makes.
template <typename T>
TileSizes cl_tile_sizes(const typename Flat<T>::LaunchParams& params, const ClDevice& device,
                        const ClOptions& options, int film_width);

struct ProgramOptions;

/// What a renderer's program is compiled for.
template <typename T>
ProgramOptions picture_program(const FlatScene<T>& scene, const ClDevice& device,
                               const ClOptions& options);

/// Work items of its groups, with packets of `lanes` rays.
std::size_t picture_group(const KernelChoice& kernels, int lanes);

/// A renderer on an OpenCL device: builds the kernels for the scene's features and uploads it. The
/// scene need not outlive the call. Throws Error: ExitCode::device if the device cannot do it,
/// ExitCode::limit, with the numbers, if the scene does not fit.
template <typename T>
std::unique_ptr<Renderer<T>> make_cl_renderer(const FlatScene<T>& scene, const ClDevice& device,
                                              const ClOptions& options);

/// Single rays on an OpenCL device, in packets as wide as for its pictures. Of the options, only
/// lanes, math and cl_options count. Throws like make_cl_renderer; the scene need not
/// outlive the call.
template <typename T>
RayTracer<T> make_cl_ray_tracer(const FlatScene<T>& scene, const ClDevice& device,
                                const ClOptions& options);

/// Chooses how many samples to launch at once so that a launch takes about a tenth of a second on
/// any device and scene: short enough for a watchdog, an interrupt and a progress bar, long enough
/// to keep a device busy. Starts small, since nothing is known yet, and learns from each launch.
class LaunchPacer {
   public:
    static constexpr double target_seconds = 0.1;
    static constexpr int most_growth = 8;  ///< from one launch to the next, which may be harder

    /// `first` samples to begin with, never more than `most` and, if that is not more, never fewer
    /// than `least`: fewer than a device runs at once would not be faster.
    LaunchPacer(std::int64_t first, std::int64_t most, std::int64_t least = 1)
        : least_(std::min(least, most)), most_(most), samples_(std::clamp(first, least_, most)) {}

    /// Samples of the next launch.
    std::int64_t samples() const { return samples_; }

    /// Records that a launch of that many samples took that long.
    void note(std::int64_t samples, double seconds) {
        // Written so that a clock that does not advance means most_growth.
        const bool is_long = target_seconds < seconds * most_growth;
        const double growth = is_long ? target_seconds / seconds : double{most_growth};
        const double wanted = static_cast<double>(samples) * growth;
        samples_ = static_cast<std::int64_t>(
            std::clamp(wanted, static_cast<double>(least_), static_cast<double>(most_)));
    }

   private:
    const std::int64_t least_, most_;
    std::int64_t samples_;
};

}  // namespace rt
