// SPDX-License-Identifier: Apache-2.0
#include "host/picture/default_scene.h"

namespace rt {

extern const char* const cornell_box_scene;  // embedded by CMake

Scene load_default_scene(const LightOverrides& light) {
    Scene scene = parse_json_scene(cornell_box_scene, default_scene_path);
    override_light(scene, light);
    return scene;
}

}  // namespace rt
