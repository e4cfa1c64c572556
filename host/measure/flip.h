// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/image/picture.h"

namespace rt {

/// What FLIP said, or why it did not.
struct FlipResult {
    std::optional<double> mean;  ///< mean FLIP error, 0 to 1; nothing when not measured
    std::string note;            ///< how it was measured, or why not and what to do
};

/// NVIDIA's FLIP (Andersson et al. 2020) for pictures on a display, at the package's own 67 pixels
/// per degree, measured by the PyPI package flip-evaluator in the python3 of PATH. The program is a
/// few embedded lines and the pixels go through an unnamed temporary file, so nothing is searched
/// for and nothing is left behind. Values are taken as a display would show them (as
/// Encoding::display stores them) and clamped; one channel is gray, and alpha is left out.
/// For pictures of one shape, without non-finite pixels.
FlipResult measure_flip(const Picture& picture, const Picture& reference);

}  // namespace rt
