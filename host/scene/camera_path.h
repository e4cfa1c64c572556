// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/scene.h"

namespace rt {

/// The scene's camera at a frame: on its path between the keys, clamped to the first and last key.
/// Throws Error (ExitCode::input) for a scene without a path, and where the view direction or up
/// vector is degenerate.
Scene::Camera camera_at(const Scene& scene, double frame);

}  // namespace rt
