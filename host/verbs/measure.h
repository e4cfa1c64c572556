// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/measure/baseline.h"
#include "host/measure/bench_result.h"
#include "host/measure/converge_result.h"
#include "host/options/options.h"
#include "host/stress/stress_result.h"

namespace rt {

// The measurements of bench and converge. Throw Error; bench also if no row
// is in the baseline, if there is one.
BenchResult measure_bench(const BenchOptions& options, const Baseline* baseline = nullptr);
ConvergeResult measure_converge(const ConvergeOptions& options);

/// The measurements of stress. Throws Error.
StressResult measure_stress(const StressOptions& options);

}  // namespace rt
