// SPDX-License-Identifier: Apache-2.0
#include "host/image/image_error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "host/base/error.h"

namespace rt {

namespace {

bool is_finite_pixel(const Picture& picture, std::size_t pixel) {
    const auto channels = static_cast<std::size_t>(picture.channels);
    const auto first = picture.pixels.begin() + static_cast<std::ptrdiff_t>(pixel * channels);
    return std::all_of(first, first + picture.channels, [](float v) { return std::isfinite(v); });
}

/// A fast scan, so that pixels need individual checks only if it returns false.
bool is_all_finite(const Picture& picture) {
    constexpr std::uint32_t exponent = 0x7f800000;
    bool any = false;
    for (const float value : picture.pixels) {
        any |= (std::bit_cast<std::uint32_t>(value) & exponent) == exponent;
    }
    return !any;
}

std::size_t pixel_count(const Picture& picture) {
    return picture.pixels.size() / static_cast<std::size_t>(picture.channels);
}

}  // namespace

std::size_t count_non_finite(const Picture& picture) {
    if (is_all_finite(picture)) return 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < pixel_count(picture); ++i) count += !is_finite_pixel(picture, i);
    return count;
}

std::pair<int, int> first_non_finite(const Picture& picture) {
    std::size_t i = 0;
    while (is_finite_pixel(picture, i)) ++i;
    const auto width = static_cast<std::size_t>(picture.width);
    return {static_cast<int>(i % width), static_cast<int>(i / width)};
}

double pixel_difference(const float* a, const float* b, int channels) {
    double largest = 0;
    for (int c = 0; c < channels; ++c) {
        if (!std::isfinite(a[c]) || !std::isfinite(b[c])) {
            return std::numeric_limits<double>::quiet_NaN();
        }
        largest = std::max(largest, std::fabs(double{a[c]} - double{b[c]}));
    }
    return largest;
}

ImageError image_error(const Picture& picture, const Picture& reference) {
    if (!have_same_shape(picture, reference)) {
        throw Error(ExitCode::bug, "the pictures differ in shape; please report this");
    }
    ImageError error;
    const auto channels = static_cast<std::size_t>(picture.channels);
    const std::size_t pixels = pixel_count(picture);
    double squares = 0, sum = 0, relative_squares = 0;
    const bool all_finite = is_all_finite(picture) && is_all_finite(reference);
    for (std::size_t i = 0; i < pixels; ++i) {
        const float* a = &picture.pixels[i * channels];
        const float* b = &reference.pixels[i * channels];
        if (all_finite && std::equal(a, a + channels, b)) continue;
        const double largest = pixel_difference(a, b, picture.channels);
        if (std::isnan(largest)) {
            ++error.non_finite;
            continue;
        }
        for (std::size_t c = 0; c < channels; ++c) {
            const double difference = double{a[c]} - double{b[c]};
            squares += difference * difference;
            sum += std::fabs(difference);
            const double relative = difference / (std::fabs(double{b[c]}) + 0.01);
            relative_squares += relative * relative;
        }
        error.over_1 += largest > levels(1) ? 1 : 0;
        error.over_2 += largest > levels(2) ? 1 : 0;
        error.over_8 += largest > levels(8) ? 1 : 0;
        if (largest > error.max) {
            error.max = largest;
            error.max_x = static_cast<int>(i % static_cast<std::size_t>(picture.width));
            error.max_y = static_cast<int>(i / static_cast<std::size_t>(picture.width));
        }
    }
    const auto compared = static_cast<double>((pixels - error.non_finite) * channels);
    const double mse = compared > 0 ? squares / compared : 0;
    error.rmse = std::sqrt(mse);
    error.mean = compared > 0 ? sum / compared : 0;
    error.rel_mse = compared > 0 ? relative_squares / compared : 0;
    error.psnr = mse > 0 ? -10 * std::log10(mse) : std::numeric_limits<double>::infinity();
    return error;
}

Picture clamped(Picture picture) {
    for (float& value : picture.pixels) {
        if (std::isfinite(value)) value = std::clamp(value, 0.0F, 1.0F);
    }
    return picture;
}

}  // namespace rt
