// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "host/image/picture.h"

namespace rt {

/// Pixels that are not finite in either picture: cyan, which the color map has nothing like.
constexpr std::array<float, 3> non_finite_color{0, 1, 1};

/// The color of a share from 0 to 1, beyond which it stays: matplotlib's magma (CC0) from black
/// over purple and orange to pale yellow, lightness rising all the way, distinguishable by
/// color-blind eyes; ten of its colors with straight lines between. Display values, red first.
std::array<float, 3> heat_color(double share);

/// The largest channel difference of each pixel as a color; `scale` is the difference at the top
/// of the color map (0: pictures without a difference). For pictures of one size and one number
/// of channels.
Picture heat_map(const Picture& picture, const Picture& reference, double scale);

}  // namespace rt
