// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "host/picture/render_stats.h"

namespace rt {

/// The text of a JSON value, indented, with a newline; bytes that are not UTF-8 (a file name may
/// hold them) become replacement characters.
std::string json_text(const nlohmann::ordered_json& json);

/// One rendering in the shape of docs/results-format.md, format "mirrorball-render", version 1.
nlohmann::ordered_json stats_json(const RenderStats& stats);

}  // namespace rt
