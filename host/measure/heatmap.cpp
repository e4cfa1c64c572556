// SPDX-License-Identifier: Apache-2.0
#include "host/measure/heatmap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "host/image/image_error.h"

namespace rt {

namespace {

constexpr std::array<std::array<int, 3>, 10> magma{{{0, 0, 4},
                                                    {24, 15, 61},
                                                    {68, 15, 118},
                                                    {114, 31, 129},
                                                    {158, 47, 127},
                                                    {205, 64, 113},
                                                    {241, 96, 93},
                                                    {253, 150, 104},
                                                    {254, 202, 141},
                                                    {252, 253, 191}}};

}  // namespace

std::array<float, 3> heat_color(double share) {
    const double at = std::clamp(share, 0.0, 1.0) * (magma.size() - 1);
    const std::size_t low = std::min(static_cast<std::size_t>(at), magma.size() - 2);
    const double rest = at - static_cast<double>(low);
    std::array<float, 3> color{};
    for (std::size_t c = 0; c < 3; ++c) {
        const double value = magma[low][c] + rest * (magma[low + 1][c] - magma[low][c]);
        color[c] = static_cast<float>(value / 255);
    }
    return color;
}

Picture heat_map(const Picture& picture, const Picture& reference, double scale) {
    Picture map{picture.width, picture.height, 3, {}};
    const auto channels = static_cast<std::size_t>(picture.channels);
    map.pixels.reserve(picture.pixels.size() / channels * 3);
    for (std::size_t i = 0; i < picture.pixels.size(); i += channels) {
        const double difference =
            pixel_difference(&picture.pixels[i], &reference.pixels[i], picture.channels);
        const auto color = std::isnan(difference)
                               ? non_finite_color
                               : heat_color(scale > 0 ? std::sqrt(difference / scale) : 0);
        map.pixels.insert(map.pixels.end(), color.begin(), color.end());
    }
    return map;
}

}  // namespace rt
