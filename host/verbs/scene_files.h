// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace rt {

/// The scene's file, first, and all that it names: models and their material libraries, whether
/// they are there and right or not. Without models while the scene's own text is wrong.
std::vector<std::string> scene_files(const std::string& scene);

}  // namespace rt
