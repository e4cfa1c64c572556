// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "host/stress/stress_result.h"

namespace rt {

/// Format "mirrorball-stress", version 1 (docs/stress.schema.json).
nlohmann::ordered_json stress_json(const StressResult& result);

}  // namespace rt
