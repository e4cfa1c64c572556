// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "host/scene/scene.h"

namespace rt {

/// Reads Eric Haines' Neutral File Format (docs/scene-format.md, "NFF"). Throws Error:
/// ExitCode::input for a file that is missing, unreadable, not regular, or wrong, with up to 20
/// mistakes, one line each; ExitCode::limit for one that is too large.
Scene load_nff_scene(const std::string& path);

/// Parses a text in memory; `file_name` appears in messages and names the scene.
Scene parse_nff_scene(std::string_view text, const std::string& file_name);

}  // namespace rt
