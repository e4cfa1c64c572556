// SPDX-License-Identifier: Apache-2.0
#include "host/render/adaptive.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rt {

namespace {

constexpr std::array<int, 4> grids{2, 4, 8, 16};

/// The largest channel difference between two pixels, clamped to 0..1; 1 if either has a NaN.
template <typename T>
double difference(const T* a, const T* b) {
    double largest = 0;
    for (int c = 0; c < 3; ++c) {
        const double d = std::fabs(static_cast<double>(std::clamp<T>(a[c], 0, 1)) -
                                   static_cast<double>(std::clamp<T>(b[c], 0, 1)));
        largest = std::max(largest, std::isnan(d) ? 1.0 : d);
    }
    return largest;
}

/// The largest difference between a pixel and its neighbors in the film.
template <typename T>
double contrast(const Film<T>& film, int x, int y) {
    const auto at = [&](int column, int row) {
        return &film.rgb[3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(film.width) +
                              static_cast<std::size_t>(column))];
    };
    double largest = 0;
    for (int row = std::max(y - 1, 0); row <= std::min(y + 1, film.height - 1); ++row) {
        for (int column = std::max(x - 1, 0); column <= std::min(x + 1, film.width - 1); ++column) {
            largest = std::max(largest, difference(at(x, y), at(column, row)));
        }
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

}  // namespace

template <typename T>
std::vector<Refinement> plan_refinement(const Film<T>& film, double threshold,
                                        std::vector<std::uint8_t>& levels) {
    std::vector<Refinement> plan(grids.size());
    for (std::size_t i = 0; i < grids.size(); ++i) plan[i].grid = grids[i];
    for (int y = 0; y < film.height; ++y) {
        for (int x = 0; x < film.width; ++x) {
            const auto pixel = static_cast<std::int32_t>(y * film.width + x);
            std::uint8_t& level = levels[static_cast<std::size_t>(pixel)];
            if (level > 1) continue;
            const int wanted = wanted_grid(contrast(film, x, y), threshold);
            if (wanted < 0) continue;
            plan[static_cast<std::size_t>(wanted)].pixels.push_back(pixel);
            level = static_cast<std::uint8_t>(grids[static_cast<std::size_t>(wanted)]);
        }
    }
    std::erase_if(plan, [](const Refinement& refinement) { return refinement.pixels.empty(); });
    return plan;
}

template std::vector<Refinement> plan_refinement(const Film<float>&, double,
                                                 std::vector<std::uint8_t>&);
template std::vector<Refinement> plan_refinement(const Film<double>&, double,
                                                 std::vector<std::uint8_t>&);

}  // namespace rt
