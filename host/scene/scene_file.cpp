// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_file.h"

#include "host/scene/json_file.h"
#include "host/scene/model_file.h"

namespace rt {

Scene load_scene_file(const std::string& path) {
    if (is_obj_name(path) || is_ply_name(path)) return load_model_scene(path);
    return load_json_scene(path);
}

}  // namespace rt
