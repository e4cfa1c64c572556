// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_name.h"

#include <filesystem>

#include "host/base/text.h"

namespace rt {

std::string name_of_file(const std::string& path) {
    return printable(std::filesystem::path(path).stem().string());
}

}  // namespace rt
