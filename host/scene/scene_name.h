// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rt {

/// A scene's name where its file gives none: that of the file, without its ending.
std::string name_of_file(const std::string& path);

}  // namespace rt
