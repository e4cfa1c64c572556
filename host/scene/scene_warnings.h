// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/scene/mesh.h"
#include "host/scene/scene.h"

namespace rt {

/// Warnings about valid but rarely intended input, one sentence each: no light at all, nothing in
/// view, colors of 0 to 255, mirrors that brighten. No false alarms, but not exhaustive.
std::vector<std::string> scene_warnings(const Scene& scene);

/// The box of all shapes.
Box bounding_box(const Scene& scene);

}  // namespace rt
