// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/image/image_error.h"
#include "host/image/picture.h"

namespace rt {

/// The picture with its finite values clamped to [0,1], what a screen can show. NaN and infinity
/// stay, to be counted.
Picture clamped(Picture picture);

/// Whether a picture is what it should be.
struct Judgement {
    std::string why_wrong;  ///< empty when it is right
    ImageError error;       ///< of the clamped values
};

/// Measures a picture against a converged one, both clamped to [0,1]. Different sampling may put it
/// far off, so only a different size and non-finite pixels are wrong.
Judgement judge_estimate(const Picture& picture, const Picture& converged);

/// Judges a picture against the double reference of the same samples, both clamped to [0,1]. The
/// same scene in other arithmetic differs by rounding everywhere, and by more only where rounding
/// decides what a sample hits. So a picture is wrong for: a different size; a non-finite pixel; all
/// black where the reference is not; a shift by one pixel; more pixels off by over 1/255 than
/// 0.1 %, a tenth of width plus height, and two; an RMSE of the rest above 2e-4.
Judgement judge_picture(const Picture& picture, const Picture& reference);

}  // namespace rt
