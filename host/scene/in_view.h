// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/scene.h"

namespace rt {

/// Whether a shape may be seen in the picture's window. False is certain: all of every shape lies
/// behind the eye, or beyond one side of the window.
bool is_anything_in_view(const Scene& scene);

}  // namespace rt
