// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "host/image/picture.h"

namespace rt {

/// Color of pixels not finite in one picture or both: cyan, unlike anything in the color map.
constexpr std::array<float, 3> non_finite_color{0, 1, 1};

/// The color of a value, clamped to 0 to 1: matplotlib's magma (CC0), from black through purple and
/// orange to pale yellow, with increasing lightness, distinguishable by color-blind eyes; ten of
/// its colors, interpolated linearly. Display values, red first.
std::array<float, 3> heat_color(double share);

/// The largest channel difference of each pixel as the color of its square root, so that small ones
/// show; `scale` is the difference at the top of the color map (0: the pictures do not differ). The
/// pictures must have the same size and number of channels.
Picture heat_map(const Picture& picture, const Picture& reference, double scale);

}  // namespace rt
