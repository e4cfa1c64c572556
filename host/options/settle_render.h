// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/options/render_options.h"

namespace rt {

/// Checks the options of `render` against one another once all are read, and derives the others.
/// Throws Error (ExitCode::usage) for options that cannot be combined.
void settle_render(RenderOptions& render);

}  // namespace rt
