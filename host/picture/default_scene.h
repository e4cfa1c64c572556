// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/scene_file.h"

namespace rt {

/// The built-in scene's name in results: its path in the repository.
inline constexpr const char* default_scene_path = "scenes/cornell-box.json";

/// The paper's scene as it was when the program was built; needs no file.
Scene load_default_scene(const LightOverrides& light = {});

}  // namespace rt
