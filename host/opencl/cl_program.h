// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <tuple>

#include "host/flatten/features.h"
#include "host/opencl/cl_device.h"
#include "host/opencl/opencl.h"
#include "host/render/picture_spec.h"

namespace rt {

inline cl::Device handle_of(const ClDevice& device) { return cl::Device(device.handle, true); }

/// The entry points of kernels/render.cl that a renderer launches; the switches RT_RENDERS_.. of
/// kernels/features.h.
struct EntryPoints {
    bool pixels = true;     ///< render_pixels
    bool samples = true;    ///< render_samples and resolve_samples
    bool rays = true;       ///< trace_rays
    bool adaptive = false;  ///< render_centers and render_adaptive
    bool edges = false;     ///< render_centers and render_edges
};

/// What a program is compiled for. `features` says what may be left out.
struct ProgramOptions {
    Precision precision = Precision::float32;
    Math math = Math::strict;
    int lanes = 1;    ///< rays of a packet: 1, 2, 4, 8 or 16
    int samples = 0;  ///< per pixel, if a packet holds them all: compiled in; 0: any number
    Features features;
    EntryPoints entries;
    std::string more;  ///< options for the driver's compiler
};

/// The options for clBuildProgram; the same for the same arguments, since drivers cache by them.
std::string build_options(const ClDevice& device, const ProgramOptions& options);

/// Compiles the source for the device. Throws Error (ExitCode::device) with device, options and the
/// compiler's log.
cl::Program build_program(const cl::Context& context, const ClDevice& device, const char* source,
                          const ProgramOptions& options);

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
