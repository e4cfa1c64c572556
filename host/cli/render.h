// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/cli/render_options.h"

namespace rt {

/// `mirrorball render`. Returns the exit status. `seconds_before_main`: time since the program
/// began.
int run_render(const RenderOptions& options, double seconds_before_main);

}  // namespace rt
