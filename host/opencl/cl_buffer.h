// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "host/opencl/cl_device.h"
#include "host/opencl/opencl.h"

namespace rt {

/// A buffer of that many bytes, or a null one (a null argument) for 0. `host`: the pointer for
/// flags such as CL_MEM_USE_HOST_PTR. Throws Error (ExitCode::limit) naming `what` if it exceeds
/// the device's largest allocation.
cl::Buffer make_cl_buffer(const cl::Context& context, const ClDevice& device, std::size_t bytes,
                          const char* what, cl_mem_flags flags = CL_MEM_READ_WRITE,
                          void* host = nullptr);

}  // namespace rt
