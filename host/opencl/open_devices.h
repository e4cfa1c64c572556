// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <tuple>

#include "host/opencl/cl_program.h"

namespace rt {

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

}  // namespace rt
