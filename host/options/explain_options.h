// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/picture/render_settings.h"
#include "host/scene/scene_file.h"

namespace rt {

/// `mirrorball explain`
struct ExplainOptions {
    std::string scene;
    LightOverrides light;
    int x = 0, y = 0;                 ///< the pixel, from the top left
    std::optional<PictureSize> size;  ///< default: the scene's
    AaMode aa = grid_aa(1);
    std::optional<int> max_bounces;
    bool json = false;
};

}  // namespace rt
