// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "host/image/picture.h"
#include "host/stress/reference_picture.h"

namespace rt {

/// How far a picture is from its reference; values clamped to [0, 1] in both.
struct PictureFigures {
    std::size_t wrong = 0;                 ///< pixels off by over 1/255 or NaN, away from edges
    std::size_t wrong_at_edges = 0;        ///< ... and at edges
    double max_error = 0;                  ///< away from edges
    std::size_t nans = 0, infinities = 0;  ///< pixels with one
};

/// Away from edges is found out only where a pixel is off by more than 2e-5: below that it is
/// taken to be.
PictureFigures judge_stress_picture(const Picture& picture, ReferencePicture& reference);

/// The same of a picture that has no reference: NaN and infinities alone.
PictureFigures count_non_numbers(const Picture& picture);

/// What breaks the tolerance, in words; empty when nothing does.
std::string exceeded_tolerance(const PictureFigures& figures, const StressTolerance& tolerance);

}  // namespace rt
