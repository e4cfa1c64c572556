// SPDX-License-Identifier: Apache-2.0
#include "host/measure/picture_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/base/text.h"

namespace rt {

namespace {

constexpr double off = 1.0 / 255;
constexpr double most_off_share = 0.001;      // of all pixels
constexpr double most_off_along_edges = 0.1;  // of the pixels of a row and a column
constexpr double most_off_anyway = 2;         // pixels, even in a small picture
constexpr double largest_rounding_rmse = 2e-4;

bool is_black(const Picture& picture) {
    return std::ranges::all_of(picture.pixels, [](float value) { return value == 0; });
}

float value_at(const Picture& picture, int x, int y, int c) {
    const auto index = (static_cast<std::ptrdiff_t>(y) * picture.width + x) * picture.channels + c;
    return picture.pixels[static_cast<std::size_t>(index)];
}

/// Mean squared difference between picture(x, y) and reference(x - dx, y - dy), without a border of
/// one pixel, so that all shifts are measured on the same pixels.
double shifted_mse(const Picture& picture, const Picture& reference, int dx, int dy) {
    double squares = 0;
    for (int y = 1; y < picture.height - 1; ++y) {
        for (int x = 1; x < picture.width - 1; ++x) {
            for (int c = 0; c < picture.channels; ++c) {
                const double distance =
                    double{value_at(picture, x, y, c)} - value_at(reference, x - dx, y - dy, c);
                squares += distance * distance;
            }
        }
    }
    const auto values =
        static_cast<double>(picture.width - 2) * (picture.height - 2) * picture.channels;
    return squares / values;
}

/// "1 right, 0 down" if the reference shifted so fits the picture with less than half the RMSE;
/// empty otherwise.
std::string shift_of(const Picture& picture, const Picture& reference) {
    if (picture.width < 4 || picture.height < 4) return "";
    double best = shifted_mse(picture, reference, 0, 0) / 4;  // half the RMSE
    std::string shift;
    for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
            const double mse = dx == 0 && dy == 0 ? best : shifted_mse(picture, reference, dx, dy);
            if (mse < best) {
                best = mse;
                shift = fmt::format("{} right, {} down", dx, dy);
            }
        }
    }
    return shift;
}

/// RMSE over the values that are off by no more than 1/255.
double rounding_rmse(const Picture& picture, const Picture& reference) {
    double squares = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const double distance = double{picture.pixels[i]} - double{reference.pixels[i]};
        if (std::fabs(distance) > off) continue;
        squares += distance * distance;
        ++count;
    }
    return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0;
}

/// The number of pixels that rounding may decide: they lie along edges, so a small picture has a
/// larger share of them. (The paper's scene at 100 x 100, grid:3: 14, on the diagonals.)
double most_pixels_off(const Picture& picture) {
    const double pixels = static_cast<double>(picture.width) * picture.height;
    const double edges = static_cast<double>(picture.width) + picture.height;
    return std::max({most_off_share * pixels, most_off_along_edges * edges, most_off_anyway});
}

std::string what_is_wrong(const Picture& picture, const Picture& reference,
                          const ImageError& error) {
    if (const std::size_t count = count_non_finite(picture); count > 0) {
        return counted(count, "pixel is", "pixels are") + " not finite";
    }
    if (error.non_finite > 0) {
        return counted(error.non_finite, "reference pixel is", "reference pixels are") +
               " not finite";
    }
    if (is_black(picture) && !is_black(reference)) return "the picture is all black";
    if (const std::string shift = shift_of(picture, reference); !shift.empty()) {
        return "the picture is shifted by a pixel: " + shift;
    }
    if (static_cast<double>(error.over_1) > most_pixels_off(picture)) {
        return fmt::format("{} off by more than 1/255, RMSE {:.2g}",
                           counted(error.over_1, "pixel is", "pixels are"), error.rmse);
    }
    if (const double rmse = rounding_rmse(picture, reference); rmse > largest_rounding_rmse) {
        return fmt::format("RMSE {:.2g}, more than rounding explains", rmse);
    }
    return "";
}

/// `why_wrong` looks at the clamped pictures.
template <typename WhyWrong>
Judgement judge(const Picture& picture, const Picture& reference, const WhyWrong& why_wrong) {
    if (!have_same_shape(picture, reference)) {
        return {fmt::format("{}x{} pixels, expected {}x{}", picture.width, picture.height,
                            reference.width, reference.height),
                {}};
    }
    const Picture shown = clamped(picture), right = clamped(reference);
    const ImageError error = image_error(shown, right);
    return {why_wrong(shown, right, error), error};
}

}  // namespace

Picture clamped(Picture picture) {
    for (float& value : picture.pixels) {
        if (std::isfinite(value)) value = std::clamp(value, 0.0F, 1.0F);
    }
    return picture;
}

Judgement judge_estimate(const Picture& picture, const Picture& converged) {
    return judge(picture, converged, [](const Picture&, const Picture&, const ImageError& error) {
        const std::size_t count = error.non_finite;
        return count > 0 ? counted(count, "pixel is", "pixels are") + " not finite" : "";
    });
}

Judgement judge_picture(const Picture& picture, const Picture& reference) {
    return judge(picture, reference, what_is_wrong);
}

}  // namespace rt
