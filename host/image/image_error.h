// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "host/image/picture.h"
#include "host/record/describe.h"

namespace rt {

/// The difference between two pictures. Channel values are compared as stored, unclamped; pixels
/// that are not finite in either picture are counted and otherwise ignored.
struct ImageError {
    double rmse = 0;             ///< root of the mean squared difference over channels
    double mean = 0;             ///< mean absolute difference
    double max = 0;              ///< largest absolute difference ...
    int max_x = 0, max_y = 0;    ///< ... and its pixel, from the top left
    double psnr = 0;             ///< dB against a peak of 1; infinity for equal pictures
    double rel_mse = 0;          ///< mean of ((a - b) / (b + 0.01))^2, b the reference, as in pbrt
    std::size_t over_1 = 0;      ///< pixels with a channel off by more than 1/255
    std::size_t over_2 = 0;      ///< ... than 2/255
    std::size_t over_8 = 0;      ///< ... than 8/255
    std::size_t non_finite = 0;  ///< pixels with a NaN or an infinity in either picture

    std::vector<int> max_at() const { return {max_x, max_y}; }
};

template <typename A, Of<ImageError> X>
void describe(A& a, X& x) {
    a("rmse", x.rmse, "root of the mean squared difference over channels");
    a("mean", x.mean, "mean absolute difference");
    a("max", x.max, "largest absolute difference");
    a("max_at", x.max_at(), "its pixel, x and y from the top left");
    a("psnr_db", finite_or_null(x.psnr), "against a peak of 1; null for equal pictures");
    a("rel_mse", x.rel_mse, "mean of ((a - b) / (b + 0.01))^2, b the reference");
    a("pixels_over_1_255", x.over_1, "pixels with a channel off by more than 1/255");
    a("pixels_over_2_255", x.over_2, "");
    a("pixels_over_8_255", x.over_8, "");
    a("non_finite", x.non_finite, "pixels with a NaN or an infinity in either picture");
}

/// Steps of an 8-bit picture, plus two float ulps below 1: pictures stored with 8 bits that are one
/// step apart do not count as over 1/255.
constexpr double levels(double count) { return count / 255 + 0x1p-23; }

/// Pixels with a NaN or an infinity in them.
std::size_t count_non_finite(const Picture& picture);

/// The first such pixel, x and y from the top left; there is one.
std::pair<int, int> first_non_finite(const Picture& picture);

/// The largest absolute channel difference of two pixels; NaN when either is not finite.
double pixel_difference(const float* a, const float* b, int channels);

/// Throws Error (ExitCode::bug) when sizes or channels differ.
ImageError image_error(const Picture& picture, const Picture& reference);

/// The picture with its finite values clamped to [0,1], what a screen can show. NaN and infinity
/// stay, to be counted.
Picture clamped(Picture picture);

}  // namespace rt
