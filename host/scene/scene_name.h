// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rt {

/// The default name of a scene: its file name without the extension.
std::string name_of_file(const std::string& path);

}  // namespace rt
