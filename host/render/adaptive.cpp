// SPDX-License-Identifier: Apache-2.0
#include "host/render/adaptive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "host/base/parallel.h"

namespace rt {

namespace {

constexpr std::array<int, 4> grids{2, 4, 8, 16};

/// The least and the greatest value of each channel of a pixel in three rows, clamped to 0..1; far
/// outside if there is a NaN.
template <typename T>
struct ColumnExtremes {
    std::vector<T> low, high;  ///< as in a film's row

    ColumnExtremes(const Film<T>& film, int row) {
        const auto values = 3 * static_cast<std::size_t>(film.width);
        low.assign(values, 1);
        high.assign(values, 0);
        for (int y = std::max(row - 1, 0); y <= std::min(row + 1, film.height - 1); ++y) {
            const T* const from = &film.rgb[static_cast<std::size_t>(y) * values];
            for (std::size_t i = 0; i < values; ++i) {
                const T value = std::clamp<T>(from[i], 0, 1);
                low[i] = std::isnan(value) ? T(-1) : std::min(low[i], value);
                high[i] = std::isnan(value) ? T(2) : std::max(high[i], value);
            }
        }
    }
};

/// The largest channel difference between a pixel of that row and its neighbors, clamped to 0..1;
/// 1 if there is a NaN.
template <typename T>
double contrast(const T* row, const ColumnExtremes<T>& around, int x, int width) {
    double largest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        T low = 1, high = 0;
        for (int column = std::max(x - 1, 0); column <= std::min(x + 1, width - 1); ++column) {
            const std::size_t i = 3 * static_cast<std::size_t>(column) + c;
            low = std::min(low, around.low[i]);
            high = std::max(high, around.high[i]);
        }
        if (low < 0) return 1;
        const double own = std::clamp<T>(row[3 * static_cast<std::size_t>(x) + c], 0, 1);
        largest =
            std::max({largest, own - static_cast<double>(low), static_cast<double>(high) - own});
    }
    return largest;
}

/// Index into grids, or -1 if one sample is enough.
int wanted_grid(double contrast, double threshold) {
    if (contrast <= threshold) return -1;
    for (std::size_t i = 0; i + 1 < grids.size(); ++i) {
        if (contrast <= threshold * grids[i]) return static_cast<int>(i);
    }
    return static_cast<int>(grids.size()) - 1;
}

using Pixels = std::array<std::vector<std::int32_t>, grids.size()>;

/// Plans one row: appends its pixels to those of the grids they want.
template <typename T>
void plan_row(const Film<T>& film, int y, double threshold, std::vector<std::uint8_t>& levels,
              Pixels& wanted_pixels) {
    const ColumnExtremes<T> around(film, y);
    const std::int32_t first = y * film.width;
    for (int x = 0; x < film.width; ++x) {
        std::uint8_t& level = levels[static_cast<std::size_t>(first + x)];
        if (level > 1) continue;
        const T* const row = &film.rgb[3 * static_cast<std::size_t>(first)];
        const int wanted = wanted_grid(contrast(row, around, x, film.width), threshold);
        if (wanted < 0) continue;
        wanted_pixels[static_cast<std::size_t>(wanted)].push_back(first + x);
        level = static_cast<std::uint8_t>(grids[static_cast<std::size_t>(wanted)]);
    }
}

}  // namespace

template <typename T>
std::vector<Refinement> plan_refinement(const Film<T>& film, double threshold,
                                        std::vector<std::uint8_t>& levels) {
    constexpr std::size_t run_length = 64;
    const auto rows = static_cast<std::size_t>(film.height);
    std::vector<Pixels> runs((rows + run_length - 1) / run_length);
    for_each_run(rows, run_length, available_cores(), [&](std::size_t first, std::size_t last) {
        for (std::size_t y = first; y < last; ++y) {
            plan_row(film, static_cast<int>(y), threshold, levels, runs[first / run_length]);
        }
    });
    std::vector<Refinement> plan;
    for (std::size_t i = 0; i < grids.size(); ++i) {
        Refinement refinement{grids[i], {}};
        for (const Pixels& run : runs) {
            refinement.pixels.insert(refinement.pixels.end(), run[i].begin(), run[i].end());
        }
        if (!refinement.pixels.empty()) plan.push_back(std::move(refinement));
    }
    return plan;
}

template <typename T>
std::vector<double> contrasts_of(const Film<T>& film, int threads) {
    const auto width = static_cast<std::size_t>(film.width);
    std::vector<double> contrasts(film.rgb.size() / 3);
    const auto rows = static_cast<std::size_t>(film.height);
    for_each_run(rows, 64, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t y = first; y < last; ++y) {
            const ColumnExtremes<T> around(film, static_cast<int>(y));
            for (std::size_t x = 0; x < width; ++x) {
                contrasts[y * width + x] =
                    contrast(&film.rgb[3 * y * width], around, static_cast<int>(x), film.width);
            }
        }
    });
    return contrasts;
}

template std::vector<double> contrasts_of(const Film<float>&, int);
template std::vector<double> contrasts_of(const Film<double>&, int);
template std::vector<Refinement> plan_refinement(const Film<float>&, double,
                                                 std::vector<std::uint8_t>&);
template std::vector<Refinement> plan_refinement(const Film<double>&, double,
                                                 std::vector<std::uint8_t>&);

}  // namespace rt
