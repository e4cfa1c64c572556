// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/scene/scene.h"

namespace rt {

/// Reads a scene file in the format that its ending names: .obj and .ply are models alone, all
/// else is .json. Throws Error: ExitCode::input for a file that is missing, unreadable, not
/// regular, or wrong; ExitCode::limit for one that is too large.
Scene load_scene(const std::string& path);

/// A scene's name where the file gives none: that of the file, without its ending.
std::string name_of_file(const std::string& path);

}  // namespace rt
