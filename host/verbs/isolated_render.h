// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "host/options/render_options.h"

namespace rt {

/// Renders in this process. `seconds_before_main`: time since the program began.
using RenderHere = std::function<int(const RenderOptions&, double seconds_before_main)>;

/// Renders in worker processes, which load the OpenCL drivers; if those fail, by `render_here` on
/// threads. Returns the exit status.
int render_isolated(const RenderOptions& options, double seconds_before_main,
                    RenderHere render_here);

}  // namespace rt
