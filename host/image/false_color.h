// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace rt
