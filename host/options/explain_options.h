// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/picture/render_settings.h"
#include "host/scene/scene_file.h"

namespace rt {

/// `mirrorball explain`
struct ExplainOptions {
    static constexpr int most_bounces = 256;  ///< deeper JSON is too much for most readers

    std::string scene;
    LightOverrides light;
    int x = 0, y = 0;         ///< the pixel, from the top left
    RenderSettings settings;  ///< only size, AA and bounces
    bool json = false;
};

}  // namespace rt
