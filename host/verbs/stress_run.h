// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/options/options.h"
#include "host/stress/stress_result.h"

namespace rt {

/// Runs the families' cases on the devices that the options name, threads and OpenCL, in float and
/// in double. Stops early, with `interrupted` on, at a stop signal. Throws Error: usage or device
/// for the devices, output for pictures.
StressResult run_stress_cases(const std::vector<StressFamily>& families,
                              const StressOptions& options);

}  // namespace rt
