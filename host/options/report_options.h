// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/options/render_options.h"

namespace rt {

/// `mirrorball report`
struct ReportOptions {
    std::vector<std::string> scenes;
    std::string output;               ///< the page
    std::string plots;                ///< the folder of its plots as files; empty: none
    std::optional<PictureSize> size;  ///< default: the scene's
    std::vector<std::string> devices{"all"};
    int repeats = 5;      ///< not counting the warm-up
    bool quick = false;   ///< fewer settings and a coarser reference: a preview, not for quoting
    bool stress = false;  ///< include the stress suite
    bool quiet = false;
};

}  // namespace rt
