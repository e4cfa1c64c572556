// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/image/picture.h"

namespace rt {

/// A FLIP measurement, or why there is none.
struct FlipResult {
    std::optional<double> mean;  ///< mean FLIP error, 0 to 1; nothing when not measured
    std::string note;            ///< how it was measured, or why not and what to do
};

/// NVIDIA's FLIP (Andersson et al. 2020) for pictures on a display, at the package's default of 67
/// pixels per degree, measured by the PyPI package flip-evaluator in the python3 of PATH. The
/// program is a few embedded lines and the pixels go through an unnamed temporary file, so no file
/// is looked up or left behind. Values are interpreted as display values (what Encoding::display
/// stores) and clamped; one channel is gray, and alpha is ignored. Both pictures must have the same
/// shape and finite pixels.
FlipResult measure_flip(const Picture& picture, const Picture& reference);

}  // namespace rt
