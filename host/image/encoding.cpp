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
void encode(std::span<const float> values, std::span<std::uint8_t> bytes, const Curve& curve) {
    std::ranges::transform(values, bytes.begin(), [&](float value) -> std::uint8_t {
        if (!(value > 0.0f)) return 0;  // NaN lands here too
        return value >= 1.0f ? 255 : curve(value);
    });
}

}  // namespace

void encode_8bit(std::span<const float> values, Encoding encoding, std::span<std::uint8_t> bytes) {
    if (encoding == Encoding::srgb) return encode(values, bytes, srgb_table());
    encode(values, bytes, [](double linear) { return round_8bit(linear); });
}

std::vector<std::uint8_t> encode_8bit(const Picture& picture, Encoding encoding) {
    std::vector<std::uint8_t> bytes(picture.pixels.size());
    encode_8bit(picture.pixels, encoding, bytes);
    return bytes;
}

}  // namespace rt
