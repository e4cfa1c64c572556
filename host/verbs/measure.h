// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/options/options.h"
#include "host/report/bench_result.h"
#include "host/report/converge_result.h"
#include "host/stress/stress_result.h"

namespace rt {

// What bench and converge measure, for them and for report. `pocl_cache` is PoCL's kernel cache
// folder (FreshKernelCache), for telling cold builds from warm ones. Throw Error.
BenchResult measure_bench(const BenchOptions& options, const std::string& pocl_cache);
ConvergeResult measure_converge(const ConvergeOptions& options, const std::string& pocl_cache);

/// What stress measures, for it and for report. Throws Error.
StressResult measure_stress(const StressOptions& options);

}  // namespace rt
