// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "host/image/picture.h"

// False-color pictures of data that is not color. Pixels without a value are black.
namespace rt {

enum class Scale { linear, logarithmic };

/// The least and the greatest of some numbers; 0 counts as none, and 0, 0 if all are.
struct NumberRange {
    float least = 0, most = 0;
};
NumberRange range_of(std::span<const float> values);

/// Maps numbers from 0 with viridis, from violet for the least to yellow for the greatest. 0 means
/// no value.
Picture color_numbers(std::span<const float> values, int width, int height, Scale scale);

/// Maps unit vectors, three numbers each, from -1..1 to 0..1 of red, green and blue. 0, 0, 0 means
/// no value.
Picture color_normals(std::span<const float> normals, int width, int height);

/// Gives each number a mostly unique color; 0 means no value.
Picture color_ids(std::span<const std::int32_t> ids, int width, int height);

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
