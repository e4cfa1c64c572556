// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "host/measure/converge_result.h"

namespace rt {

/// Format "mirrorball-converge", version 1 (docs/converge.schema.json): every raw run, and the
/// figures computed from them.
nlohmann::ordered_json converge_json(const ConvergeResult& result);

}  // namespace rt
