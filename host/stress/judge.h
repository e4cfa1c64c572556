// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "host/image/picture.h"
#include "host/stress/reference_picture.h"

namespace rt {

/// Errors of a picture against its reference, both clamped to [0, 1].
struct PictureFigures {
    std::size_t wrong = 0;                 ///< pixels off by over 1/255 or NaN, away from edges
    std::size_t wrong_at_edges = 0;        ///< ... and at edges
    double max_error = 0;                  ///< away from edges
    std::size_t nans = 0, infinities = 0;  ///< pixels with one
};

template <typename A, Of<PictureFigures> X>
void describe(A& a, X& x) {
    a("wrong", x.wrong, "pixels off by over 1/255, or NaN, away from edges");
    a("wrong_at_edges", x.wrong_at_edges, "and at edges");
    a("max_error", finite_or_null(x.max_error), "away from edges");
    a("nan", x.nans, "pixels with a NaN");
    a("infinite", x.infinities, "pixels with an infinity");
}

/// Edges are looked up only for pixels off by more than 2e-5; all others count as away from edges.
PictureFigures judge_stress_picture(const Picture& picture, ReferencePicture& reference);

/// The same for a picture without a reference: counts NaN and infinities only.
PictureFigures count_non_numbers(const Picture& picture);

/// What exceeds the tolerance, in words; empty if nothing does.
std::string exceeded_tolerance(const PictureFigures& figures, const StressTolerance& tolerance);
std::string exceeded_tolerance(const RayFigures& rays, const StressTolerance& tolerance);

}  // namespace rt
