// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "host/measure/bench_result.h"

namespace rt {

/// The shape of docs/bench.schema.json, format "mirrorball-bench", version 1: every raw run, and
/// the figures made of them.
nlohmann::ordered_json bench_json(const BenchResult& result);

}  // namespace rt
