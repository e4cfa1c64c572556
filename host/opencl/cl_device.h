// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/opencl/pocl.h"
#include "host/record/describe.h"

struct _cl_device_id;

namespace rt {

/// An OpenCL device and its relevant properties.
struct ClDevice {
    int index = 0;           ///< flat, as `mirrorball devices` prints it
    int platform_index = 0;  ///< platform, and device within it
    int device_index = 0;
    std::string name, vendor, driver, version, platform;
    std::string kind;  ///< "CPU", "GPU" or "accelerator"
    unsigned compute_units = 0;
    unsigned float_lanes = 0, double_lanes = 0;  ///< native vector widths; 0: no such type
    std::uint64_t memory_bytes = 0, max_buffer_bytes = 0;
    bool has_double = false;
    bool rounds_correctly = false;  ///< promises correctly rounded float division and sqrt
    bool keeps_subnormals = false;  ///< float
    std::string unusable;           ///< why it cannot render; empty when it can
    _cl_device_id* handle = nullptr;

    bool is_cpu() const { return kind == "CPU"; }
    bool is_gpu() const { return kind == "GPU"; }
};

template <typename A, Of<ClDevice> X>
void describe(A& a, X& x) {
    a("index", x.index, "");
    a("platform_index", x.platform_index, "");
    a("device_index", x.device_index, "");
    a("name", x.name, "");
    a("vendor", x.vendor, "");
    a("platform", x.platform, "");
    a("driver", x.driver, "");
    a("version", x.version, "");
    a("kind", x.kind, "");
    a("compute_units", x.compute_units, "");
    a("float_lanes", x.float_lanes, "");
    a("double_lanes", x.double_lanes, "");
    a("memory_bytes", x.memory_bytes, "");
    a("max_buffer_bytes", x.max_buffer_bytes, "");
    a("has_double", x.has_double, "");
    a("rounds_correctly", x.rounds_correctly, "");
    a("keeps_subnormals", x.keeps_subnormals, "");
    a("usable", x.unusable.empty(), "");
    a("unusable_because", x.unusable, "");
}

/// Every OpenCL device, in the loader's order; none when there is no OpenCL.
struct ClDeviceList {
    std::vector<ClDevice> devices;
    std::vector<std::string> problems{};  ///< what went wrong, one line each
    std::string failure{};  ///< the first that a driver reported as an error, not as no device
};

/// Never throws for a missing or broken platform.
ClDeviceList list_cl_devices();

}  // namespace rt
