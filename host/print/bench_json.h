// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "host/measure/bench_result.h"

namespace rt {

/// Format "mirrorball-bench", version 1 (docs/bench.schema.json): every raw run, and the figures
/// computed from them.
nlohmann::ordered_json bench_json(const BenchResult& result);

}  // namespace rt
