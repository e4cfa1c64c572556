// SPDX-License-Identifier: Apache-2.0
#pragma once

// The OpenCL C++ bindings with the settings all of mirrorball uses. Only the cl_* files of this
// folder (and the kernel tests) include this.
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_TARGET_OPENCL_VERSION 120
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wignored-attributes"
#include <CL/opencl.hpp>
#pragma GCC diagnostic pop

#include <cstddef>
#include <string>
#include <vector>

#include "host/flatten/flat_scene.h"
#include "host/opencl/cl_device.h"

namespace rt {

/// The name of an OpenCL status, such as "CL_OUT_OF_RESOURCES (-5)".
std::string cl_status_text(int status);

/// A buffer of that many bytes, or a null one (a null argument) for 0. `host`: the pointer for
/// flags such as CL_MEM_USE_HOST_PTR. Throws Error (ExitCode::limit) naming `what` if it exceeds
/// the device's largest allocation.
cl::Buffer make_cl_buffer(const cl::Context& context, const ClDevice& device, std::size_t bytes,
                          const char* what, cl_mem_flags flags = CL_MEM_READ_WRITE,
                          void* host = nullptr);

/// A flat scene on a device: a buffer for each of its lists, in kernels/render.cl's order. The
/// scene need not outlive the call. Throws like make_cl_buffer.
template <typename T>
std::vector<cl::Buffer> upload_scene(const FlatScene<T>& scene, const cl::Context& context,
                                     const cl::CommandQueue& queue, const ClDevice& device);

/// Sets them as a kernel's arguments from `first` on. Returns the number of the next argument.
cl_uint set_arguments(cl::Kernel& kernel, cl_uint first, const std::vector<cl::Buffer>& scene);

}  // namespace rt
