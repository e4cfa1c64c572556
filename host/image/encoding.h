// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/base/text.h"
#include "host/image/picture.h"

namespace rt {

/// How 8-bit files store the linear-light film. Float files (.exr, .pfm) ignore it.
///
/// - display: value * 255, no curve, as in the paper; the file declares no color space.
/// - srgb: the transfer curve of IEC 61966-2-1, then * 255; the file declares sRGB.
/// - linear: the same numbers as display; the file declares linear light (PNG gAMA 1.0).
enum class Encoding { display, srgb, linear };

inline constexpr Named<Encoding> encoding_names[] = {
    {"display", Encoding::display}, {"srgb", Encoding::srgb}, {"linear", Encoding::linear}};

/// The transfer curve of IEC 61966-2-1 from linear light to the stored value, both in [0, 1].
double srgb_from_linear(double linear);

/// Encodes values: clamped to [0, 1], through the encoding's curve, then floor(x * 255 + 0.5).
/// NaN becomes 0; callers count non-finite pixels first.
void encode_8bit(std::span<const float> values, Encoding encoding, std::span<std::uint8_t> bytes);

/// The whole picture as 8 bits.
std::vector<std::uint8_t> encode_8bit(const Picture& picture, Encoding encoding);

}  // namespace rt
