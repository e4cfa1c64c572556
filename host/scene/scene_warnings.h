// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/scene/scene.h"

namespace rt {

/// What is allowed in a scene and hardly ever meant, a sentence each: no light at all, nothing in
/// view, colors of 0 to 255, mirrors that brighten. What is reported is so; not all of it is found.
std::vector<std::string> scene_warnings(const Scene& scene);

}  // namespace rt
