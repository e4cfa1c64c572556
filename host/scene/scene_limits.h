// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rt {

/// The largest magnitude of any number in a scene or model file: it fits a float, with headroom for
/// the differences that rendering computes.
inline constexpr double max_scene_number = 1e30;

/// The largest reflectance or transmission: light of 1e30 is still a float after one surface.
inline constexpr double max_reflectance = 1e6;

// The largest picture a scene file may ask for, in pixels.
inline constexpr int max_image_side = 65536;
inline constexpr int max_image_pixels = 1 << 28;

}  // namespace rt
