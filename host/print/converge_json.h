// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "host/measure/converge_result.h"

namespace rt {

/// The shape of docs/converge.schema.json, format "mirrorball-converge", version 1: every raw run,
/// and the figures made of them.
nlohmann::ordered_json converge_json(const ConvergeResult& result);

}  // namespace rt
