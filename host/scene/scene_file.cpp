// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_file.h"

#include <algorithm>
#include <filesystem>

#include "host/scene/json_file.h"
#include "host/scene/model_file.h"

namespace rt {
namespace {

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

}  // namespace

Scene load_scene(const std::string& path) {
    if (is_obj_name(path) || is_ply_name(path)) return load_model_scene(path);
    return load_json_scene(path);
}

std::string name_of_file(const std::string& path) {
    std::string name = std::filesystem::path(path).stem().string();
    std::ranges::replace_if(name, is_control, '?');
    return name;
}

}  // namespace rt
