// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/opencl/device_spec.h"

namespace rt {

/// A device to be measured.
struct ListedDevice {
    std::string spec;  ///< for --device: "threads", "threads:2", "0"
    DeviceChoice choice;
    std::string name;        ///< "threads", or the OpenCL device's own name
    bool is_scalar = false;  ///< threads that trace one ray at a time

    bool is_threads() const { return choice.use_threads; }
    bool has_double() const { return is_threads() || choice.device.has_double; }
};

/// The devices that specs name, without duplicates; "all" means threads and every usable OpenCL
/// device, with a line on stderr for each unusable one. Throws Error (usage or device) like
/// choose_device. OpenCL is not loaded if only threads are named.
std::vector<ListedDevice> listed_devices(const std::vector<std::string>& specs);

}  // namespace rt
