// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "host/measure/bench_result.h"

namespace rt {

/// Human-readable tables, at most 100 columns wide.
std::string bench_text(const BenchResult& result);

/// Format "mirrorball-bench", version 1 (docs/bench.schema.json): every raw run, and the figures
/// computed from them.
nlohmann::ordered_json bench_json(const BenchResult& result);

/// A header and a line per run, warm-up (round 0) and repeats.
std::string bench_csv(const BenchResult& result);

}  // namespace rt
