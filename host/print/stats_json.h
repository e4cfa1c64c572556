// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "host/picture/render_stats.h"

namespace rt {

/// A JSON value as indented text with a newline; invalid UTF-8 (a file name may hold it) becomes
/// replacement characters.
std::string json_text(const nlohmann::ordered_json& json);

/// One rendering in format "mirrorball-render", version 1 (docs/results-format.md).
nlohmann::ordered_json stats_json(const RenderStats& stats);

}  // namespace rt
