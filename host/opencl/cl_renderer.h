// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "host/flatten/flat_scene.h"
#include "host/opencl/cl_device.h"
#include "host/render/launch.h"
#include "host/render/renderer.h"

namespace rt {

/// Whether a launch on this device has a work item per sample.
bool launches_samples(Launch launch, const ClDevice& device);

/// Rays of a packet on this device: what was asked for, or (0) its native vector width on CPUs and
/// one on GPUs, which run a packet's rays side by side themselves.
template <typename T>
int packet_lanes(int asked_for, const ClDevice& device);

struct ClOptions {
    Launch launch = Launch::automatic;
    int lanes = 0;  ///< rays of a packet: 1, 2, 4, 8 or 16; 0: as suits the device
    bool fast_math = false;
    bool will_refine = false;          ///< build the kernel that `refine` needs, too
    bool all_features = false;         ///< compile what scene and renderer do not need, too
    Features also = no_features();     ///< compile these, needed or not
    bool any_samples = false;          ///< compile the loop over samples, needed or not
    bool shares_film = false;          ///< others render into the film at the same time
    bool warnings_are_errors = false;  ///< for tests
};

/// What Renderer::tile_size and most_tile_pixels say of the renderer that make_cl_renderer makes.
struct ClTiles {
    Rect best;
    std::int64_t most_pixels;
};
template <typename T>
ClTiles cl_tiles(const typename Flat<T>::LaunchParams& params, const ClDevice& device,
                 const ClOptions& options, int film_width);

/// A renderer on an OpenCL device: builds the kernels for the scene's features and uploads it. The
/// scene may go once this returns. Throws Error: ExitCode::device when the device cannot do it,
/// ExitCode::limit when the scene does not fit, with the numbers.
template <typename T>
std::unique_ptr<Renderer<T>> make_cl_renderer(const FlatScene<T>& scene, const ClDevice& device,
                                              const ClOptions& options);

}  // namespace rt
