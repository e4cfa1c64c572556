// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/options/stress_options.h"
#include "host/stress/stress_result.h"

namespace rt {

/// Times the paper's scene and options.cost_scene on each device, in float: as it is, wholly naive,
/// and with each technique alone made naive. On threads, the C++ baseline beside the naive tracer
/// of the stress suite. Stops early, with `interrupted` on, at a stop signal. Throws Error.
StressResult measure_technique_costs(const StressOptions& options);

}  // namespace rt
