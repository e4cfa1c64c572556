// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "host/flatten/flat_types.h"
#include "host/opencl/cl_device.h"
#include "host/opencl/cl_options.h"
#include "host/render/rect.h"

namespace rt {

/// Whether a launch on this device has a work item per sample.
bool launches_samples(Launch launch, const ClDevice& device);

/// Rays of a packet on this device: what was asked for, or (0) its native vector width on CPUs and
/// one on GPUs, which run a packet's rays side by side themselves.
template <typename T>
int packet_lanes(int asked_for, const ClDevice& device);

/// Work items of one launch, at most. PoCL compiles a kernel again when a grid passes 64 K items,
/// so a CPU launch stays below; a GPU wants more to fill up.
std::size_t most_items(const ClDevice& device);

/// What Renderer::tile_size and most_tile_pixels say of the renderer that make_cl_renderer makes.
struct ClTiles {
    Rect best;
    std::int64_t most_pixels;
};
template <typename T>
ClTiles cl_tiles(const typename Flat<T>::LaunchParams& params, const ClDevice& device,
                 const ClOptions& options, int film_width);

}  // namespace rt
