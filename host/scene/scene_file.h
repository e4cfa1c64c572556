// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "host/scene/scene.h"

namespace rt {

/// Light that replaces what a scene file says, or leaves open.
struct LightOverrides {
    std::optional<double> light_scale;  ///< intensity of lights that have none of their own
    std::optional<glm::dvec3> ambient_light;
};

/// The name of standard input among scene files.
inline constexpr const char* stdin_scene = "-";

/// Reads a scene file in the format that its ending names: .nff, a model alone in .obj or
/// .ply, else .json; "-" is JSON from standard input, whose folder is the working folder. Throws
/// Error: ExitCode::input for a file that is missing, unreadable, not regular, or wrong;
/// ExitCode::limit for one that is too large.
Scene load_scene(const std::string& path, const LightOverrides& light = {});

/// Gives a scene the light that replaces its own.
void override_light(Scene& scene, const LightOverrides& light);

}  // namespace rt
