// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "host/stress/stress_result.h"

namespace rt {

/// The shape of docs/stress.schema.json, format "mirrorball-stress", version 1.
nlohmann::ordered_json stress_json(const StressResult& result);

}  // namespace rt
