// SPDX-License-Identifier: Apache-2.0
#include "host/measure/pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace rt {

namespace {

/// The value rounded to the three digits that tables show: what nobody sees decides nothing.
double shown(double value) {
    if (!(value > 0) || !std::isfinite(value)) return value;
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2);
    return std::round(value / unit) * unit;
}

}  // namespace

std::vector<std::size_t> pareto_front(std::span<const Cost> costs) {
    std::vector<std::size_t> order(costs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const double seconds_a = shown(costs[a].seconds), seconds_b = shown(costs[b].seconds);
        return seconds_a != seconds_b ? seconds_a < seconds_b : costs[a].rmse < costs[b].rmse;
    });
    std::vector<std::size_t> front;
    double best = std::numeric_limits<double>::infinity();
    for (const std::size_t i : order) {
        if (!(shown(costs[i].rmse) < best)) continue;
        best = shown(costs[i].rmse);
        front.push_back(i);
    }
    return front;
}

std::optional<double> log_log_slope(std::span<const Cost> costs) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const Cost& cost : costs) {
        if (!(cost.seconds > 0) || !(cost.rmse > 0)) continue;
        const double u = std::log(cost.seconds), v = std::log(cost.rmse);
        n += 1;
        x += u;
        y += v;
        xx += u * u;
        xy += u * v;
    }
    const double spread = n * xx - x * x;
    if (n < 2 || !(spread > 0)) return std::nullopt;
    return (n * xy - x * y) / spread;
}

}  // namespace rt
