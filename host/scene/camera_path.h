// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/scene.h"

namespace rt {

/// The scene's camera at a frame: on its path between the keys, before the first and after the last
/// where these are. Throws Error (ExitCode::input) for a scene without a path, and where the view
/// has no direction or no up.
Scene::Camera camera_at(const Scene& scene, double frame);

}  // namespace rt
