// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_name.h"

#include <algorithm>
#include <filesystem>

#include "host/scene/utf8.h"

namespace rt {

std::string name_of_file(const std::string& path) {
    std::string name = std::filesystem::path(path).stem().string();
    std::ranges::replace_if(name, is_control, '?');
    return name;
}

}  // namespace rt
