// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/measure/bench_result.h"

namespace rt {

/// Human-readable tables, at most 100 columns wide.
std::string bench_text(const BenchResult& result);

}  // namespace rt
