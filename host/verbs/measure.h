// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/measure/bench_result.h"
#include "host/measure/converge_result.h"
#include "host/options/options.h"
#include "host/stress/stress_result.h"

namespace rt {

// What bench and converge measure, for them and for report. Throw Error.
BenchResult measure_bench(const BenchOptions& options);
ConvergeResult measure_converge(const ConvergeOptions& options);

/// What stress measures, for it and for report. Throws Error.
StressResult measure_stress(const StressOptions& options);

}  // namespace rt
