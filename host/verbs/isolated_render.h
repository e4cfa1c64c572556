// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "host/options/render_options.h"

namespace rt {

/// Renders in this process. `seconds_before_main`: time since the program began.
using RenderHere = std::function<int(const RenderOptions&, double seconds_before_main)>;

/// Renders in a worker process, which loads the OpenCL drivers; if that fails, `render_here`
/// finishes the picture or batch on threads. Returns the exit status.
int render_isolated(RenderOptions options, double seconds_before_main,
                    const RenderHere& render_here);

}  // namespace rt
