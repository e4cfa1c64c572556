// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace rt {

/// `mirrorball compare`
struct CompareOptions {
    std::string picture, reference;
    std::optional<double> max_rmse, max_abs;
    std::optional<int> max_pixels;        ///< with a difference over 1/255
    std::string heatmap;                  ///< empty: none
    std::optional<double> heatmap_scale;  ///< default: the largest difference
    std::string json;                     ///< empty: text; "-": JSON on stdout; else JSON to a file
    bool clamp = false;                   ///< to 0..1, as 8-bit files do
};

}  // namespace rt
