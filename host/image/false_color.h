// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "host/image/picture.h"

// Pictures of what is no color. What has no value is black.
namespace rt {

enum class Scale { linear, logarithmic };

/// Numbers from 0 by the viridis map, from the least to the largest; a legend below the picture
/// names both, and what is half-way. 0 is no value.
Picture color_numbers(std::span<const float> values, int width, int height, Scale scale);

/// Unit vectors, three numbers each: -1 to 1 becomes 0 to 1 of red, green and blue. The legend is a
/// ball, x to the right, y up, z toward the viewer. 0, 0, 0 is no value.
Picture color_normals(std::span<const float> normals, int width, int height);

/// Each number a color of its own, more or less; 0 is no value. Without a legend.
Picture color_ids(std::span<const std::int32_t> ids, int width, int height);

}  // namespace rt
