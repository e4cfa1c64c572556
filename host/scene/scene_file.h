// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/scene/scene.h"

namespace rt {

/// Reads a scene of any kind we know, by the ending of its name: .obj and .ply are models,
/// anything else is mirrorball's JSON. Throws Error as their readers do.
Scene load_scene_file(const std::string& path);

}  // namespace rt
