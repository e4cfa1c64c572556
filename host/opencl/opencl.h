// SPDX-License-Identifier: Apache-2.0
#pragma once

// The OpenCL C++ bindings with the settings all of mirrorball uses. Only the sources of this folder
// and the self-test (and the kernel tests) include this.
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_TARGET_OPENCL_VERSION 120
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wignored-attributes"
#include <CL/opencl.hpp>
#pragma GCC diagnostic pop

#include <cstddef>
#include <map>
#include <mutex>
#include <string>
#include <tuple>
#include <vector>

#include "host/flatten/flat_scene.h"
#include "host/opencl/devices.h"
#include "host/render/picture_spec.h"

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

inline cl::Device handle_of(const ClDevice& device) { return cl::Device(device.handle, true); }

/// The entry points of kernels/render.cl that a renderer launches; the switches RT_RENDERS_.. of
/// kernels/features.h.
struct EntryPoints {
    bool pixels = true;     ///< render_pixels
    bool samples = true;    ///< render_samples and resolve_samples
    bool rays = true;       ///< trace_rays
    bool adaptive = false;  ///< render_centers and render_round
    bool edges = false;     ///< likewise, in an edges mode
};

/// What a program is compiled for. `features` says what may be left out.
struct ProgramOptions {
    Precision precision = Precision::float32;
    Math math = Math::strict;
    int lanes = 1;    ///< rays of a packet: 1, 2, 4, 8 or 16
    int samples = 0;  ///< per pixel, if a packet holds them all: compiled in; 0: any number
    Features features = every_feature;
    EntryPoints entries;
    std::string more;  ///< options for the driver's compiler
};

/// The options for clBuildProgram; the same for the same arguments, since drivers cache by them.
std::string build_options(const ClDevice& device, const ProgramOptions& options);

/// Compiles the source for the device. Throws Error (ExitCode::device) with device, options and the
/// compiler's log.
cl::Program build_program(const cl::Context& context, const ClDevice& device, const char* source,
                          const ProgramOptions& options);

/// Work items per group: as many as wanted, but no more than the device can run of the kernel.
std::size_t fitting_group(const cl::Kernel& kernel, const ClDevice& device, std::size_t wanted);

/// Contexts and programs kept from picture to picture. Thread-safe.
class OpenDevices {
   public:
    cl::Context context(const ClDevice& device);

    /// As build_program, in that context; built once.
    cl::Program program(const ClDevice& device, const char* source, const ProgramOptions& options);

   private:
    using Key = std::tuple<cl_device_id, const char*, std::string>;

    std::mutex mutex_;
    std::map<cl_device_id, cl::Context> contexts_;
    std::map<Key, cl::Program> programs_;
};

/// The Error (ExitCode::device) for an OpenCL call that failed.
[[noreturn]] void throw_device_error(const ClDevice& device, const cl::Error& error);

}  // namespace rt
