// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "host/report/report_data.h"
#include "host/report/rows.h"

namespace rt {

/// Any run of the scene, for its scene data.
const RenderStats& some_run(const ReportScene& scene);

/// The scene's name, or else its file.
std::string scene_name(const ReportScene& scene);

/// The fastest row of the largest picture; empty where nothing was timed.
std::optional<PlacedRow> fastest_row(const ReportScene& scene, std::size_t index);

/// "PoCL traces Cornell box in 22 ms: 14.7 times as fast as one thread"; empty where nothing was
/// timed.
std::string verdict_text(const ReportScene& scene, std::size_t index);

/// "500 x 500 pixels, 2 x 2 samples per pixel (grid:2), float. All 24 ...": the details behind the
/// verdict.
std::string verdict_details(const ReportScene& scene, std::size_t index);

}  // namespace rt
