// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/report/render_stats.h"

namespace rt {

/// One line: what was rendered where, how fast, and the picture's hash.
std::string summary_line(const RenderStats& stats);

/// One line: every figure of an image error.
std::string error_line(const ImageError& error);

/// The table of --stats: phases as in the paper (set-up, ray trace, resolve and write, total), rays
/// by kind, and what the scene needed and did not need.
std::string stats_text(const RenderStats& stats);

}  // namespace rt
