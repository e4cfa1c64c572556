// SPDX-License-Identifier: Apache-2.0
#include "host/image/false_color.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "host/image/image_error.h"

namespace rt {

namespace {

using Color = std::array<float, 3>;

/// Samples of matplotlib's viridis at equal distances.
constexpr std::array<Color, 5> viridis{{{0.267f, 0.005f, 0.329f},
                                        {0.230f, 0.322f, 0.546f},
                                        {0.128f, 0.567f, 0.551f},
                                        {0.369f, 0.789f, 0.383f},
                                        {0.993f, 0.906f, 0.144f}}};

/// Of bytes.
constexpr std::array<Color, 10> magma{{{0, 0, 4},
                                       {24, 15, 61},
                                       {68, 15, 118},
                                       {114, 31, 129},
                                       {158, 47, 127},
                                       {205, 64, 113},
                                       {241, 96, 93},
                                       {253, 150, 104},
                                       {254, 202, 141},
                                       {252, 253, 191}}};

/// The color at a share, clamped to 0 to 1, of the way along a map, over `most`.
Color color_at(std::span<const Color> map, double share, double most) {
    const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(map.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), map.size() - 2);
    Color color;
    for (std::size_t k = 0; k < 3; ++k) {
        color[k] = static_cast<float>(
            std::lerp(map[below][k], map[below + 1][k], place - static_cast<double>(below)) / most);
    }
    return color;
}

template <typename ColorOf>
Picture colored(int width, int height, const ColorOf& color_of) {
    Picture picture{width, height, 3, {}};
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    picture.pixels.reserve(3 * pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const Color color = color_of(i);
        picture.pixels.insert(picture.pixels.end(), color.begin(), color.end());
    }
    return picture;
}

}  // namespace

NumberRange range_of(std::span<const float> values) {
    NumberRange range;
    for (const float value : values) {
        if (value == 0) continue;
        range.least = range.least == 0 ? value : std::min(range.least, value);
        range.most = std::max(range.most, value);
    }
    return range;
}

Picture color_numbers(std::span<const float> values, int width, int height, Scale scale) {
    const auto [least, most] = range_of(values);
    return colored(width, height, [&, least = least, most = most](std::size_t i) {
        if (values[i] == 0) return Color{};
        const bool is_logarithmic = scale == Scale::logarithmic;
        const float share = is_logarithmic ? std::log(values[i] / least) / std::log(most / least)
                                           : (values[i] - least) / (most - least);
        return color_at(viridis, most > least ? share : 0, 1);
    });
}

Picture color_normals(std::span<const float> normals, int width, int height) {
    return colored(width, height, [&](std::size_t i) {
        const auto normal = normals.subspan(3 * i, 3);
        if (normal[0] == 0 && normal[1] == 0 && normal[2] == 0) return Color{};
        return Color{0.5f * normal[0] + 0.5f, 0.5f * normal[1] + 0.5f, 0.5f * normal[2] + 0.5f};
    });
}

Picture color_ids(std::span<const std::int32_t> ids, int width, int height) {
    return colored(width, height, [&](std::size_t i) {
        if (ids[i] == 0) return Color{};
        // Neighbors get colors far apart: multiples of an odd number near 2^32 / golden ratio.
        const std::uint32_t mixed = static_cast<std::uint32_t>(ids[i]) * 0x9e3779b1u;
        const auto part = [&](int shift) {
            return 0.25f + 0.75f * static_cast<float>(mixed >> shift & 255u) / 255;
        };
        return Color{part(24), part(14), part(4)};
    });
}

std::array<float, 3> heat_color(double share) { return color_at(magma, share, 255); }

Picture heat_map(const Picture& picture, const Picture& reference, double scale) {
    const auto channels = static_cast<std::size_t>(picture.channels);
    return colored(picture.width, picture.height, [&](std::size_t i) {
        const double difference = pixel_difference(
            &picture.pixels[channels * i], &reference.pixels[channels * i], picture.channels);
        return std::isnan(difference) ? non_finite_color
                                      : heat_color(scale > 0 ? std::sqrt(difference / scale) : 0);
    });
}

}  // namespace rt
