// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "host/flatten/flat_scene.h"
#include "host/opencl/cl_device.h"
#include "host/opencl/cl_options.h"
#include "host/render/renderer.h"

namespace rt {

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

}  // namespace rt
