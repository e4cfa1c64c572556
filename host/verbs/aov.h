// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/options/render_options.h"
#include "host/picture/render_stats.h"
#include "host/scene/scene.h"

namespace rt {

/// Refuses, before anything is computed, files of options.aovs that could not be written.
void check_aov_files(const RenderOptions& options);

/// Writes what options.aovs asks for of the picture beside it: all of them as the channels of
/// NAME.aov.exr where the picture is an .exr, else each in false colors as NAME.depth.png and so
/// on. `scene` is as it was rendered. Returns false, with a message and nothing written, when a
/// stop signal came meanwhile. Throws Error (ExitCode::output).
bool write_aovs(const Scene& scene, const RenderStats& stats, const RenderOptions& options);

}  // namespace rt
