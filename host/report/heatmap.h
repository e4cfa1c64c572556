// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "host/image/picture.h"

namespace rt {

/// Pixels that are not finite in either picture: cyan, which the colour map has nothing like.
constexpr std::array<float, 3> non_finite_colour{0, 1, 1};

/// The colour of a share from 0 to 1, beyond which it stays: matplotlib's magma (CC0) from black
/// over purple and orange to pale yellow, lightness rising all the way, told apart by
/// colour-blind eyes; ten of its colours with straight lines between. Display values, red first.
std::array<float, 3> heat_colour(double share);

/// The largest channel difference of each pixel as a colour; `scale` is the difference at the top
/// of the colour map (0: pictures without a difference). For pictures of one size and one number
/// of channels.
Picture heat_map(const Picture& picture, const Picture& reference, double scale);

}  // namespace rt
