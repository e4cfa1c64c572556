// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/record/describe.h"
#include "host/render/film.h"
#include "host/render/threads_renderer.h"
#include "host/render/tile_queue.h"
#include "host/scene/aa_mode.h"

// The error of a picture without a reference, from a few control pixels that are traced again with
// many samples, in two independent sets. If I is a pixel's value and R1 and R2 are unbiased means
// of such sets, the expectation of (I - R1)(I - R2) is the squared error of I, however I was
// computed.
namespace rt {

/// An estimate of a picture's RMSE over channels, clamped to 0..1, relative to what more and more
/// samples would give.
struct ErrorEstimate {
    double rmse = 0;            ///< 0: too small to tell, below `high`
    double low = 0, high = 0;   ///< the true RMSE lies between them in about 6 of 7 pictures
    std::uint64_t pixels = 0;   ///< control pixels
    std::uint64_t samples = 0;  ///< traced for the estimate; no part of the picture's rays
    double seconds = 0;
    double target = 0;  ///< the RMSE wanted; 0: none

    std::optional<double> known_rmse() const {
        return rmse > 0 ? std::optional(rmse) : std::nullopt;
    }
    bool reaches(double target_rmse) const { return known_rmse().value_or(high) <= target_rmse; }
};

/// "RMSE about 8.1e-4 (6.0e-4 to 1.1e-3)", "RMSE below 1.1e-3" or "no error found".
std::string to_string(const ErrorEstimate& estimate);

template <typename A, Of<ErrorEstimate> X>
void describe(A& a, X& x) {
    a("rmse", or_null(x.known_rmse()),
      "over channels, clamped to 0..1; null: too small to tell, below high");
    a("low", x.low, "in about 6 of 7 pictures the true RMSE is between low and high");
    a("high", x.high, "");
    a("pixels", x.pixels, "control pixels");
    a("samples", x.samples, "traced for the estimate");
    a("seconds", x.seconds, "to estimate");
    a("target", x.target > 0 ? std::optional(x.target) : std::nullopt, "of --target-rmse");
}

/// The film's colors, RGB, in these pixels of it.
template <typename T>
std::vector<double> colors_of(const std::vector<std::int32_t>& pixels, const Film<T>& film) {
    std::vector<double> colors;
    for (const std::int32_t pixel : pixels) {
        const T* const rgb = &film.rgb[3 * static_cast<std::size_t>(pixel)];
        colors.insert(colors.end(), rgb, rgb + 3);
    }
    return colors;
}

/// Some of a picture's pixels, and what they should be.
struct ControlPixels {
    std::vector<std::int32_t> pixels;          ///< indices into the film, ascending
    std::vector<double> weights;               ///< of each in the mean over the whole picture
    std::vector<double> candidate_weights;     ///< among all candidates, ...
    std::size_t candidates = 0;                ///< ... of which there were so many
    std::array<std::vector<double>, 2> means;  ///< RGB, independent
    int depth = 0;                             ///< samples of each mean
    std::uint64_t samples = 0;                 ///< traced for all this

    /// Of a picture with these colors, RGB, in the control pixels. Those with a NaN count as right.
    ErrorEstimate estimate(std::span<const double> colors) const;

    template <typename T>
    ErrorEstimate estimate_of(const Film<T>& film) const {
        return estimate(colors_of(pixels, film));
    }
};

/// Traces single pixels of `region` of a picture, on threads.
template <typename T>
struct ErrorEstimator {
    const FlatScene<T>& scene;
    Rect region;
    ThreadsOptions options;
    const StopFlag& stop;

    /// Chooses control pixels of a film that shows the region sampled with `aa`, and traces them.
    /// First candidates are chosen, half of them evenly and half where neighbors differ; then
    /// control pixels among these, half of them where a few more samples differ from the film. If
    /// the error is below 1e-3 and lost in the noise of the control pixels, these get four times as
    /// many samples, and again, until it is clear or they have as many as the picture's. Everything
    /// depends on the scene and the film alone. Empty if stopped.
    std::optional<ControlPixels> trace_controls(const AaMode& aa, const Film<T>& film) const;

    /// The first AA mode after `aa`, a grid, Sobol or edges, that reaches the RMSE in the control
    /// pixels, with 2, 3, 4, 6, 8, 12, ... samples or rows of them, or two thirds of the tolerance
    /// and again; the finest of all if none does. Edges that do not get there at an eighth of the
    /// RMSE make way for Sobol. Only the control pixels are traced, so it takes little time; their
    /// means get at least as many samples. Empty if stopped.
    std::optional<AaMode> mode_to_reach(double rmse, AaMode aa, ControlPixels& controls) const;

   private:
    std::vector<double> trace(const std::vector<std::int32_t>& pixels, const AaMode& aa, int seed,
                              std::uint64_t& samples) const;
    ControlPixels choose_controls(const Film<T>& film) const;
    void trace_means(int depth, ControlPixels& controls) const;
};

}  // namespace rt
