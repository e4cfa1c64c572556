// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "host/scene/scene.h"

namespace rt {

/// Light that overrides the scene file's, or sets what it leaves open.
struct LightOverrides {
    std::optional<double> light_scale;  ///< intensity of lights without their own
    std::optional<glm::dvec3> ambient_light;
};

/// The scene path that means standard input.
inline constexpr const char* stdin_scene = "-";

/// Reads a scene file in the format of its extension: .nff, a single model in .obj or .ply, else
/// .json; "-" is JSON from standard input, relative to the working folder. Throws Error:
/// ExitCode::input for a file that is missing, unreadable, not regular, or wrong; ExitCode::limit
/// for one that is too large.
Scene load_scene(const std::string& path, const LightOverrides& light = {});

/// Applies the overrides to a scene.
void override_light(Scene& scene, const LightOverrides& light);

/// The built-in scene's name in results: its path in the repository.
inline constexpr const char* default_scene_path = "scenes/cornell-box.json";

/// The paper's scene as it was when the program was built; needs no file.
Scene load_default_scene(const LightOverrides& light = {});

// Texts in memory; `file_name` appears in messages and gives the default name. Throw Error:
// ExitCode::input with up to 20 mistakes, one line each; ExitCode::limit for too many values.

/// Mirrorball's own scene format (docs/scene-format.md).
Scene parse_json_scene(std::string_view text, const std::string& file_name);

/// Eric Haines' Neutral File Format (docs/scene-format.md, "NFF").
Scene parse_nff_scene(std::string_view text, const std::string& file_name);

}  // namespace rt
