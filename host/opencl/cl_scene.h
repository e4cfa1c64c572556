// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/flatten/flat_scene.h"
#include "host/opencl/cl_device.h"
#include "host/opencl/opencl.h"

namespace rt {

/// A flat scene on a device: a buffer for each of its lists.
template <typename T>
class ClScene {
   public:
    /// Uploads; the scene need not outlive the call. Throws Error (ExitCode::limit) if a list does
    /// not fit.
    ClScene(const FlatScene<T>& scene, const cl::Context& context, const cl::CommandQueue& queue,
            const ClDevice& device);

    /// Sets a kernel's arguments from `first` on, in kernels/render.cl's order. Returns the number
    /// of the next argument.
    cl_uint set_arguments(cl::Kernel& kernel, cl_uint first) const;

   private:
    std::vector<cl::Buffer> lists_;  // in the order of the kernels' arguments
};

}  // namespace rt
