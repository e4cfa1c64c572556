// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/opencl/cl_renderer.h"
#include "host/render/ray_tracer.h"

namespace rt {

/// Single rays on an OpenCL device, in packets as wide as for its pictures. Of the options, only
/// lanes, math and warnings_are_errors count. Throws like make_cl_renderer; the scene need not
/// outlive the call.
template <typename T>
RayTracer<T> make_cl_ray_tracer(const FlatScene<T>& scene, const ClDevice& device,
                                const ClOptions& options);

}  // namespace rt
