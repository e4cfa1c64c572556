// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/scene/json_document.h"
#include "host/scene/mistakes.h"
#include "host/scene/scene.h"

namespace rt {

/// Reads the "camera" object of a scene file; camera_window computes the window unless the file
/// gives one. Notes errors in `mistakes`.
Scene::Camera read_camera(const JsonValue& value, Mistakes& mistakes);

}  // namespace rt
