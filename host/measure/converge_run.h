// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/measure/converge.h"
#include "host/picture/render_settings.h"

namespace rt {

/// What to measure.
struct ConvergeOptions {
    std::string scene;
    std::optional<PictureSize> size;  ///< default: the scene's
    std::vector<AaMode> aa;
    std::vector<std::string> devices{"all"};
    int threads = 0;      ///< of the pthreads renderer; 0: all cores
    bool scalar = false;  ///< also threads one ray at a time, in float
    std::vector<Precision> precisions{Precision::float32, Precision::float64};
    std::vector<Math> math{Math::strict};
    std::vector<int> max_bounces;  ///< empty: the scene's
    LightOverrides light;
    int repeats = 5;               ///< not counting the warm-up
    int reference_samples = 1024;  ///< per pixel, in each half of the reference
    std::string reference;         ///< the file it is kept in; empty: none
    bool quiet = false;
};

/// Measures. Throws Error.
ConvergeResult measure_converge(const ConvergeOptions& options);

}  // namespace rt
