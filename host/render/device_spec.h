// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/render/cl_device.h"

namespace rt {

/// What `--device` names: the pthreads baseline, or one OpenCL device.
struct DeviceChoice {
    bool use_threads = false;
    int threads = 0;   ///< from threads:N; 0 when not given
    ClDevice device;   ///< meaningless for threads
    std::string note;  ///< why it is not what one might expect, for stderr; often empty
};

/// Whether the text names the pthreads baseline ("threads" or "threads:N"), so that OpenCL need not
/// be looked for. Throws Error (ExitCode::usage) for threads:0 and the like.
bool names_threads(const std::string& spec, DeviceChoice& choice);

/// Whether the text leaves the choice to the program: "auto" or "".
bool is_auto(const std::string& spec);

/// What can be chosen without loading OpenCL: threads where the text names them, or where it leaves
/// the choice and this machine shows no GPU. Throws as names_threads.
std::optional<DeviceChoice> choose_without_opencl(const std::string& spec);

/// Throws Error (ExitCode::usage) unless the text is a spec, whatever devices there are.
void check_device_spec(const std::string& spec);

/// Chooses among the devices: "0", "0:1", "pocl", "name:TEXT", "cpu", "gpu", or "auto": a
/// GPU or accelerator if there is one, else threads, which start sooner than OpenCL on the same
/// CPU. Text must fit exactly one usable device, else Error (ExitCode::usage) lists the candidates;
/// a device that cannot be used is Error (ExitCode::device) with the reason; "auto" then chooses
/// threads and says so in `note`.
DeviceChoice choose_device(const std::string& spec, const std::vector<ClDevice>& devices,
                           const std::vector<std::string>& problems);

}  // namespace rt
