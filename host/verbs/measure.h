// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/measure/baseline.h"
#include "host/measure/bench.h"
#include "host/measure/converge.h"
#include "host/options/options.h"
#include "host/stress/stress_result.h"

namespace rt {

// The measurements of bench and converge, also used by report. Throw Error; bench also if no row
// is in the baseline, if there is one.
BenchResult measure_bench(const BenchOptions& options, const Baseline* baseline = nullptr);
ConvergeResult measure_converge(const ConvergeOptions& options);

/// The measurements of stress, also used by report. Throws Error.
StressResult measure_stress(const StressOptions& options);

}  // namespace rt
