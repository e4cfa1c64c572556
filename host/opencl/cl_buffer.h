// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "host/opencl/cl_device.h"
#include "host/opencl/opencl.h"

namespace rt {

/// A buffer of that many bytes; an empty one is no buffer at all (a null argument). `host`: what
/// flags like CL_MEM_USE_HOST_PTR speak of. Throws Error (ExitCode::limit) naming `what` when the
/// device gives less in one piece.
cl::Buffer make_cl_buffer(const cl::Context& context, const ClDevice& device, std::size_t bytes,
                          const char* what, cl_mem_flags flags = CL_MEM_READ_WRITE,
                          void* host = nullptr);

}  // namespace rt
