// SPDX-License-Identifier: Apache-2.0
#include "host/opencl/open_devices.h"

#include "host/opencl/cl_options.h"

namespace rt {

std::shared_ptr<OpenDevices> make_open_devices() { return std::make_shared<OpenDevices>(); }

cl::Context OpenDevices::context(const ClDevice& device) {
    const std::lock_guard lock(mutex_);
    cl::Context& context = contexts_[device.handle];
    if (context() == nullptr) context = cl::Context(handle_of(device));
    return context;
}

cl::Program OpenDevices::program(const ClDevice& device, const char* source,
                                 const ProgramOptions& options) {
    const cl::Context of = context(device);
    const std::lock_guard lock(mutex_);
    cl::Program& program = programs_[{device.handle, source, build_options(device, options)}];
    if (program() == nullptr) program = build_program(of, device, source, options);
    return program;
}

}  // namespace rt
