// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/opencl/pocl.h"

struct _cl_device_id;

namespace rt {

/// An OpenCL device and its relevant properties.
struct ClDevice {
    int index = 0;           ///< flat, as `mirrorball devices` prints it
    int platform_index = 0;  ///< platform, and device within it
    int device_index = 0;
    std::string name, vendor, driver, version, platform;
    bool is_cpu = false, is_gpu = false;
    unsigned compute_units = 0;
    unsigned float_lanes = 0, double_lanes = 0;  ///< native vector widths; 0: no such type
    std::uint64_t memory_bytes = 0, max_buffer_bytes = 0;
    bool has_double = false;
    bool rounds_correctly = false;  ///< promises correctly rounded float division and sqrt
    bool keeps_subnormals = false;  ///< float
    std::string unusable;           ///< why it cannot render; empty when it can
    _cl_device_id* handle = nullptr;
};

/// Every OpenCL device, in the loader's order; empty when there is no OpenCL. Never throws for a
/// missing or broken platform: what went wrong is added to `problems`, one line each; the first
/// that a driver reported as an error, rather than having no device, is copied to `failure`.
std::vector<ClDevice> list_cl_devices(std::vector<std::string>& problems,
                                      std::string* failure = nullptr);

}  // namespace rt
