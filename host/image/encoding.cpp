// SPDX-License-Identifier: Apache-2.0
#include "host/image/encoding.h"

#include <cmath>
#include <cstddef>
#include <string>

#include "host/error.h"

namespace rt {

std::string_view to_string(Encoding encoding) {
    switch (encoding) {
        case Encoding::display:
            return "display";
        case Encoding::srgb:
            return "srgb";
        case Encoding::linear:
            return "linear";
    }
    throw Error(ExitCode::bug, "encoding: unknown value; please report this");
}

Encoding parse_encoding(std::string_view name) {
    for (const Encoding encoding : {Encoding::display, Encoding::srgb, Encoding::linear}) {
        if (name == to_string(encoding)) return encoding;
    }
    throw Error(ExitCode::usage, "--encoding: unknown encoding '" + std::string(name) +
                                     "'; use display, srgb or linear");
}

double srgb_from_linear(double linear) {
    if (linear <= 0.0031308) return 12.92 * linear;
    return 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

std::uint8_t encode_8bit(float value, Encoding encoding) {
    if (!(value > 0.0f)) return 0;  // NaN lands here too
    if (value >= 1.0f) return 255;
    const double linear = value;  // in double the product below is exact
    const double stored = encoding == Encoding::srgb ? srgb_from_linear(linear) : linear;
    return static_cast<std::uint8_t>(std::floor(stored * 255.0 + 0.5));
}

std::vector<std::uint8_t> encode_8bit(const Picture& picture, Encoding encoding) {
    const auto channels = static_cast<std::size_t>(picture.channels);
    const bool has_alpha = channels == 2 || channels == 4;
    std::vector<std::uint8_t> bytes(picture.pixels.size());
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const bool is_alpha = has_alpha && i % channels == channels - 1;
        bytes[i] = encode_8bit(picture.pixels[i], is_alpha ? Encoding::linear : encoding);
    }
    return bytes;
}

}  // namespace rt
