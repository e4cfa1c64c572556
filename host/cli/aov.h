// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/cli/render_options.h"
#include "host/picture/render_stats.h"
#include "host/scene/scene.h"

namespace rt {

/// Rejects, before anything is computed, AOV files that could not be written, or are inputs.
void check_aov_files(const RenderOptions& options, const std::vector<std::string>& inputs);

/// Writes the AOVs in options.aovs next to the picture: as channels of NAME.aov.exr if the picture
/// is an .exr, else each in false color as NAME.depth.png and so on. `scene` is as it was rendered.
/// Returns false, with a message and nothing written, after a stop signal. Throws Error
/// (ExitCode::output).
bool write_aovs(const Scene& scene, const RenderStats& stats, const RenderOptions& options);

}  // namespace rt
