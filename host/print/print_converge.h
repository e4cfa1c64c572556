// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "host/measure/converge_result.h"

namespace rt {

/// Human-readable tables, at most 100 columns wide.
std::string converge_text(const ConvergeResult& result);

/// Format "mirrorball-converge", version 1 (docs/converge.schema.json): every raw run, and the
/// figures computed from them.
nlohmann::ordered_json converge_json(const ConvergeResult& result);

/// A header and a line per run, warm-up (round 0) and repeats.
std::string converge_csv(const ConvergeResult& result);

}  // namespace rt
