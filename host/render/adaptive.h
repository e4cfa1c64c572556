// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "host/render/film.h"

namespace rt {

/// Film pixels that need a finer grid of samples; `pixels` are indices into the film, ascending.
struct Refinement {
    int grid = 1;  ///< samples per side
    std::vector<std::int32_t> pixels;
};

/// Which pixels of an adaptively sampled film to render again, and how finely. A pixel that differs
/// from one of its eight neighbors by c (the largest channel difference, channels clamped to 0..1)
/// gets the coarsest grid of 2, 4, 8 or 16 samples per side, n, for which c / n <= threshold: the
/// error of an edge pixel under an n x n grid is about c / n. `levels` holds each pixel's current
/// samples per side and is updated; only pixels still at 1 are considered, so that a second call
/// after refining finds what the refined pixels revealed next to them.
template <typename T>
std::vector<Refinement> plan_refinement(const Film<T>& film, double threshold,
                                        std::vector<std::uint8_t>& levels);

/// Each pixel's largest channel difference from its eight neighbors, clamped to 0..1; 1 near a NaN.
template <typename T>
std::vector<double> contrasts_of(const Film<T>& film, int threads);

}  // namespace rt
