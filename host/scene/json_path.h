// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/json_document.h"
#include "host/scene/mistakes.h"
#include "host/scene/scene.h"

namespace rt {

/// Reads "path". Keys inherit what they omit from `camera`, the scene's own.
Scene::CameraPath read_camera_path(const JsonValue& value, const Scene::Camera& camera,
                                   Mistakes& mistakes);

}  // namespace rt
