// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rt {

// The largest picture a scene file may ask for, in pixels.
inline constexpr int max_image_side = 65536;
inline constexpr int max_image_pixels = 1 << 28;

}  // namespace rt
