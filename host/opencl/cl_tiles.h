// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "host/opencl/cl_device.h"
#include "host/opencl/cl_options.h"
#include "host/render/renderer.h"

namespace rt {

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

}  // namespace rt
