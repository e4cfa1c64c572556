// SPDX-License-Identifier: Apache-2.0
#include "host/image/encoding.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <ranges>

namespace rt {

double srgb_from_linear(double linear) {
    if (linear <= 0.0031308) return 12.92 * linear;
    return 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

namespace {

std::uint8_t round_8bit(double stored) { return static_cast<std::uint8_t>(stored * 255.0 + 0.5); }

/// A lookup table from floats in (0, 1) to sRGB bytes, 10 times as fast as the curve: floats with
/// the same first 16 bits map to at most two different bytes.
class SrgbTable {
   public:
    SrgbTable() {
        for (std::size_t first = 0; first < first_bits; ++first) {
            bytes_[first] = byte_of(static_cast<std::uint32_t>(first << 16));
        }
        const std::ranges::iota_view floats(std::uint32_t{0}, std::uint32_t{first_bits << 16});
        for (std::size_t byte = 0; byte < ends_.size(); ++byte) {
            const auto end = std::ranges::partition_point(
                floats, [byte](std::uint32_t bits) { return byte_of(bits) <= byte; });
            ends_[byte] = static_cast<std::uint32_t>(end - floats.begin());
        }
    }

    std::uint8_t operator()(float value) const {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        const std::uint8_t byte = bytes_[bits >> 16];
        return static_cast<std::uint8_t>(byte + (bits >= ends_[byte] ? 1 : 0));
    }

   private:
    static constexpr std::size_t first_bits = 0x3f80;  // of 1.0f

    static std::uint8_t byte_of(std::uint32_t bits) {
        return round_8bit(srgb_from_linear(std::bit_cast<float>(bits)));
    }

    std::array<std::uint8_t, first_bits> bytes_;  ///< of the least value with the first 16 bits
    std::array<std::uint32_t, 256> ends_;         ///< the value that each byte ends before
};

const SrgbTable& srgb_table() {
    static const SrgbTable table;
    return table;
}

template <typename Curve>
std::uint8_t encode_clamped(float value, const Curve& curve) {
    if (!(value > 0.0f)) return 0;  // NaN lands here too
    if (value >= 1.0f) return 255;
    return curve(value);
}

template <typename Curve>
void encode_row(std::span<const float> values, std::size_t channels, std::span<std::uint8_t> bytes,
                const Curve& curve) {
    const bool has_alpha = channels == 2 || channels == 4;
    for (std::size_t i = 0; i < values.size(); ++i) {
        bytes[i] = encode_clamped(values[i], curve);
        if (has_alpha && i % channels == channels - 1) {
            bytes[i] = encode_8bit(values[i], Encoding::linear);
        }
    }
}

}  // namespace

std::uint8_t encode_8bit(float value, Encoding encoding) {
    return encode_clamped(value, [encoding](double linear) {  // in double the product is exact
        return round_8bit(encoding == Encoding::srgb ? srgb_from_linear(linear) : linear);
    });
}

void encode_8bit_row(const Picture& picture, int y, Encoding encoding,
                     std::span<std::uint8_t> bytes) {
    const auto channels = static_cast<std::size_t>(picture.channels);
    const std::size_t count = static_cast<std::size_t>(picture.width) * channels;
    const std::span row(picture.pixels.data() + count * static_cast<std::size_t>(y), count);
    if (encoding == Encoding::srgb) return encode_row(row, channels, bytes, srgb_table());
    encode_row(row, channels, bytes, [](double linear) { return round_8bit(linear); });
}

std::vector<std::uint8_t> encode_8bit(const Picture& picture, Encoding encoding) {
    std::vector<std::uint8_t> bytes(picture.pixels.size());
    const std::size_t count = static_cast<std::size_t>(picture.width) * picture.channels;
    for (int y = 0; y < picture.height; ++y) {
        encode_8bit_row(picture, y, encoding, std::span(bytes).subspan(count * y, count));
    }
    return bytes;
}

}  // namespace rt
