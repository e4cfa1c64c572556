// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/flatten/flat_scene.h"
#include "host/render/cl_device.h"

namespace rt {

/// A buffer of that many bytes; an empty one is no buffer at all (a null argument). `host`: what
/// flags like CL_MEM_USE_HOST_PTR speak of. Throws Error (ExitCode::limit) naming `what` when the
/// device gives less in one piece.
cl::Buffer make_cl_buffer(const cl::Context& context, const ClDevice& device, std::size_t bytes,
                          const char* what, cl_mem_flags flags = CL_MEM_READ_WRITE,
                          void* host = nullptr);

/// A flat scene on a device: a buffer for each of its lists.
template <typename T>
class ClScene {
   public:
    /// Uploads; the scene may go once this returns. Throws Error (ExitCode::limit) when a list does
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
