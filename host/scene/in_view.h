// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/scene.h"

namespace rt {

/// Whether a shape may be visible in the picture's window. False is certain: every shape lies
/// entirely behind the eye or outside one side of the window.
bool is_anything_in_view(const Scene& scene);

}  // namespace rt
