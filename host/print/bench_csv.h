// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/measure/bench_result.h"

namespace rt {

/// A header and a line per run, warm-up (round 0) and repeats.
std::string bench_csv(const BenchResult& result);

}  // namespace rt
