// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/measure/bench_result.h"
#include "host/measure/converge_result.h"
#include "host/options/options.h"
#include "host/stress/stress_result.h"

namespace rt {

// The measurements of bench and converge, also used by report. Throw Error.
BenchResult measure_bench(const BenchOptions& options);
ConvergeResult measure_converge(const ConvergeOptions& options);

/// The measurements of stress, also used by report. Throws Error.
StressResult measure_stress(const StressOptions& options);

}  // namespace rt
