// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/options/render_options.h"

namespace rt {

/// Renders several scenes, one after the other, on devices that are opened once. A scene that fails
/// does not stop the others. Returns the worst exit status of all.
int render_batch(const RenderOptions& options);

}  // namespace rt
