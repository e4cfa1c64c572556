// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/scene/scene.h"

namespace rt {

struct MtlLibrary {
    std::vector<Scene::Material> materials;
    std::vector<std::string> notes;  ///< what was left out, a sentence each
};

/// Reads a material library (Wavefront, 1992; docs/scene-format.md maps its keywords to ours).
/// Throws Error, ExitCode::input, with up to 20 mistakes.
MtlLibrary parse_mtl(std::string_view text, const std::string& file_name);

}  // namespace rt
