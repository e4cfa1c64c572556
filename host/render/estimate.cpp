// SPDX-License-Identifier: Apache-2.0
#include "host/render/estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "host/base/parallel.h"
#include "host/render/tile_rounds.h"

namespace rt {

namespace {

// Together 0.5 samples per pixel at 500 x 500. Candidates are many, to find errors that lie in few
// pixels; control pixels have many samples, to tell small errors from noise.
constexpr std::size_t candidate_count = 8192, control_count = 512;
constexpr int candidate_samples = 8, control_samples = 64;

/// An error above this is not worth more samples.
constexpr double large_rmse = 1e-3;

/// Sampling seeds, to be combined with the picture's own: all sets of samples are independent.
constexpr int candidates_seed = 0x2f6e2b10, control_seeds[] = {0x2f6e2b11, 0x2f6e2b12};

/// In 0..1, by Wellons' triple32 as in kernels/sampling.cl.
double random_number(std::size_t n) {
    auto v = static_cast<std::uint32_t>(n);
    v = (v ^ (v >> 17)) * 0xed5ad4bbu;
    v = (v ^ (v >> 11)) * 0xac4c1b51u;
    v = (v ^ (v >> 15)) * 0x31848babu;
    return (v ^ (v >> 14)) * 0x1p-32;
}

bool is_clear(const ErrorEstimate& estimate) {
    return estimate.rmse > large_rmse || estimate.high < 2 * estimate.low;
}

/// Of a pixel; with edges, as many Sobol samples as are near enough to a pixel that is done
/// (kernels/lines.cl).
int most_pixel_samples(const AaMode& aa) {
    if (aa.refines()) return 256;
    if (!aa.finds_edges()) return aa.samples();
    const double samples = std::pow(0.07 / aa.threshold, 4.0 / 3);
    return static_cast<int>(std::min<double>(samples, AaMode::max_sobol));
}

/// "8.1e-4", or "0".
std::string short_text(double value) {
    if (value == 0) return "0";
    std::string text = fmt::format("{:.1e}", value);
    if (const auto sign = text.find("e-0"); sign != std::string::npos) text.erase(sign + 2, 1);
    return text;
}

AaMode sobol_aa(int samples) { return {AaMode::Pattern::sobol, samples, 0}; }

/// The next of 2, 3, 4, 6, 8, 12, ... samples or rows, or two thirds of the tolerance.
AaMode finer(AaMode aa) {
    if (aa.finds_edges()) {
        const auto rounded = parse_number<double>(fmt::format("{:.2g}", aa.threshold / 1.5));
        aa.threshold = std::max(*rounded, AaMode::min_tolerance);
        return aa;
    }
    const bool is_power_of_two = (aa.count & (aa.count - 1)) == 0;
    const int more = is_power_of_two ? aa.count / 2 : aa.count / 3;
    const int most = aa.pattern == AaMode::Pattern::grid ? AaMode::max_grid : AaMode::max_sobol;
    aa.count = std::min(aa.count + std::max(more, 1), most);
    return aa;
}

/// Draws items, one from each of `count` equal parts of the sum of their chances, so that they are
/// spread over all. An item's chance is half in proportion to its weight, half to its size. Calls
/// take(item, times drawn over times expected).
template <typename Weight, typename Take>
void draw(const std::vector<double>& sizes, const Weight& weight, std::size_t count,
          const Take& take) {
    double size = 0, all = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        size += sizes[i];
        all += weight(i);
    }
    const auto draws = static_cast<double>(count);
    double reached = 0;
    std::size_t drawn = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const double even = weight(i) / all;
        const double expected = (size > 0 ? (even + sizes[i] / size) / 2 : even) * draws;
        reached += expected;
        const std::size_t before = drawn;
        while (drawn < count && static_cast<double>(drawn) + random_number(drawn) < reached) {
            ++drawn;
        }
        if (drawn > before) take(i, static_cast<double>(drawn - before) / expected);
    }
}

/// Each pixel's largest channel difference from its eight neighbors, clamped to 0..1; 1 near a NaN.
template <typename T>
std::vector<double> contrasts_of(const Film<T>& film, int threads) {
    const auto rows = static_cast<std::size_t>(film.height);
    const std::size_t values = 3 * static_cast<std::size_t>(film.width);  // of a row
    std::vector<double> contrasts(film.rgb.size() / 3);
    for_each_run(rows, 64, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t y = first; y < last; ++y) {
            std::vector<T> low(values, 1), high(values, 0);  // of three rows; -1: a NaN
            for (std::size_t row = y > 0 ? y - 1 : 0; row < std::min(y + 2, rows); ++row) {
                for (std::size_t i = 0; i < values; ++i) {
                    const T value = std::clamp<T>(film.rgb[row * values + i], 0, 1);
                    low[i] = std::isnan(value) ? T(-1) : std::min(low[i], value);
                    high[i] = std::max(high[i], value);
                }
            }
            for (std::size_t i = 0; i < values; ++i) {
                const std::size_t left = i < 3 ? i : i - 3, right = i + 3 < values ? i + 3 : i;
                const double least = std::min({low[left], low[i], low[right]});
                const double most = std::max({high[left], high[i], high[right]});
                const double own = std::clamp<T>(film.rgb[y * values + i], 0, 1);
                double& contrast = contrasts[(y * values + i) / 3];
                contrast = least < 0 ? 1 : std::max({contrast, own - least, most - own});
            }
        }
    });
    return contrasts;
}

/// The mean over channels of (value - a)(value - b), all clamped to 0..1; 0 with a NaN.
double product(const double* value, const double* a, const double* b) {
    const auto clamped = [](double v) { return std::clamp(v, 0.0, 1.0); };
    double sum = 0;
    for (int c = 0; c < 3; ++c) {
        sum += (clamped(value[c]) - clamped(a[c])) * (clamped(value[c]) - clamped(b[c]));
    }
    return std::isfinite(sum) ? sum / 3 : 0;
}

}  // namespace

ErrorEstimate ControlPixels::estimate(std::span<const double> colors) const {
    double sum = 0, squares = 0, candidate_squares = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double part =
            weights[i] * product(&colors[3 * i], &means[0][3 * i], &means[1][3 * i]);
        sum += part;
        squares += part * part;
        candidate_squares += part * part * candidate_weights[i] / weights[i];
    }
    // Of drawing control pixels from the candidates, and of drawing those.
    const double variance =
        std::max(squares - sum * sum / static_cast<double>(pixels.size()), 0.0) +
        std::max(candidate_squares - sum * sum / static_cast<double>(candidates), 0.0);
    // 90 % of a normal distribution; a square below 0 is all noise.
    double margin = std::max(1.645 * std::sqrt(variance), -sum);
    if (pixels.size() == 1) {  // only its two means tell of noise
        margin = std::max(margin, product(means[0].data(), means[1].data(), means[1].data()));
    }
    ErrorEstimate estimate;
    estimate.rmse = std::sqrt(std::max(sum, 0.0));
    estimate.low = std::sqrt(std::max(sum - margin, 0.0));
    estimate.high = std::sqrt(std::max(sum, 0.0) + margin);
    estimate.pixels = pixels.size();
    estimate.samples = samples;
    return estimate;
}

std::string to_string(const ErrorEstimate& estimate) {
    if (estimate.high == 0) return "no error found";
    if (!estimate.known_rmse()) return "RMSE below " + short_text(estimate.high);
    return fmt::format("RMSE about {} ({} to {})", short_text(estimate.rmse),
                       short_text(estimate.low), short_text(estimate.high));
}

/// The colors, RGB, of pixels sampled so; adds their samples. `seed`: to be combined with the
/// picture's.
template <typename T>
std::vector<double> ErrorEstimator<T>::trace(const std::vector<std::int32_t>& pixels,
                                             const AaMode& aa, int seed,
                                             std::uint64_t& samples) const {
    ThreadsOptions any_samples = options;
    any_samples.kernels.any_samples = true;
    any_samples.kernels.features[feature::sobol] = true;
    const NativeKernels<T>& kernels = native_kernels_for(scene, any_samples);
    NativeView<T> view = native_view(scene);
    const bool is_sobol = aa.pattern == AaMode::Pattern::sobol;
    view.params.sampling = is_sobol ? f32::RT_SAMPLES_SOBOL : f32::RT_SAMPLES_GRID;
    view.params.grid = is_sobol ? 0 : aa.count;
    view.params.samples = aa.samples();
    view.params.tolerance = aa.finds_edges() ? static_cast<T>(aa.threshold) : T(0);
    view.params.threshold = 0;
    view.params.seed ^= seed;
    std::vector<T> colors(3 * pixels.size());
    std::atomic<std::uint64_t> at_edges = 0;
    constexpr std::size_t run = 16;
    for_each_run(pixels.size(), run, thread_count(options, 1),
                 [&](std::size_t first, std::size_t last) {
                     std::vector<T> planes;
                     typename Flat<T>::RayCounts counts{};
                     for (std::size_t i = first; i < last; ++i) {
                         const Rect pixel{region.x + pixels[i] % region.width,
                                          region.y + pixels[i] / region.width, 1, 1};
                         const auto tile = flat_tile<T>(pixel, pixel);
                         T* const color = &colors[3 * i];
                         if (aa.finds_edges()) {
                             render_tile_in_rounds(kernels, view, tile, planes, color, counts,
                                                   [] { return false; });
                         } else {
                             kernels.render_pixel(color, &counts, &view, &tile, 0, 1);
                         }
                     }
                     at_edges += counts.primary;
                 });
    samples += pixels.size() * static_cast<std::uint64_t>(aa.samples()) + at_edges;
    return {colors.begin(), colors.end()};
}

template <typename T>
ControlPixels ErrorEstimator<T>::choose_controls(const Film<T>& film) const {
    const std::vector<double> contrasts = contrasts_of(film, thread_count(options, 1));
    const auto even = [](std::size_t) { return 1.0; };
    ControlPixels candidates, controls;
    draw(contrasts, even, candidate_count, [&](std::size_t i, double weight) {
        candidates.pixels.push_back(static_cast<std::int32_t>(i));
        candidates.weights.push_back(weight / static_cast<double>(contrasts.size()));
    });
    const std::vector<double> own = colors_of(candidates.pixels, film);
    const std::vector<double> others =
        trace(candidates.pixels, sobol_aa(candidate_samples), candidates_seed, controls.samples);
    std::vector<double> squares;
    for (std::size_t i = 0; i < candidates.pixels.size(); ++i) {
        squares.push_back(candidates.weights[i] *
                          product(&own[3 * i], &others[3 * i], &others[3 * i]));
    }
    const auto weight_of = [&](std::size_t i) { return candidates.weights[i]; };
    draw(squares, weight_of, control_count, [&](std::size_t i, double weight) {
        controls.pixels.push_back(candidates.pixels[i]);
        controls.candidate_weights.push_back(candidates.weights[i]);
        controls.weights.push_back(candidates.weights[i] * weight);
    });
    controls.candidates = candidates.pixels.size();
    return controls;
}

/// The two means, of so many samples each.
template <typename T>
void ErrorEstimator<T>::trace_means(int depth, ControlPixels& controls) const {
    for (std::size_t k = 0; k < 2; ++k) {
        controls.means[k] =
            trace(controls.pixels, sobol_aa(depth), control_seeds[k], controls.samples);
    }
    controls.depth = depth;
}

template <typename T>
std::optional<ControlPixels> ErrorEstimator<T>::trace_controls(const AaMode& aa,
                                                               const Film<T>& film) const {
    ControlPixels controls = choose_controls(film);
    const int most = most_pixel_samples(aa);
    for (int depth = control_samples; stop == 0; depth *= 4) {
        trace_means(depth, controls);
        const ErrorEstimate estimate = controls.estimate_of(film);
        if (is_clear(estimate) || depth >= most) return controls;
    }
    return std::nullopt;
}

template <typename T>
std::optional<AaMode> ErrorEstimator<T>::mode_to_reach(double rmse, AaMode aa,
                                                       ControlPixels& controls) const {
    while (stop == 0) {
        // What an edges mode misses it misses at any tolerance.
        const bool gives_up =
            aa.finds_edges() && aa.threshold <= std::max(rmse / 8, AaMode::min_tolerance);
        const AaMode next = gives_up ? sobol_aa(control_samples) : finer(aa);
        if (next == aa) return aa;
        aa = next;
        if (most_pixel_samples(aa) > controls.depth) {
            trace_means(std::max(most_pixel_samples(aa), 2 * controls.depth), controls);
        }
        const auto colors = trace(controls.pixels, aa, 0, controls.samples);
        if (controls.estimate(colors).reaches(rmse)) return aa;
    }
    return std::nullopt;
}

template struct ErrorEstimator<float>;
template struct ErrorEstimator<double>;

}  // namespace rt
