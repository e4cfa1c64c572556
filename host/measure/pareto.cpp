// SPDX-License-Identifier: Apache-2.0
#include "host/measure/pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace rt {

std::vector<std::size_t> pareto_front(std::span<const Cost> costs) {
    std::vector<std::size_t> order(costs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        if (costs[a].seconds != costs[b].seconds) return costs[a].seconds < costs[b].seconds;
        return costs[a].rmse < costs[b].rmse;
    });
    std::vector<std::size_t> front;
    double best = std::numeric_limits<double>::infinity();
    for (const std::size_t i : order) {
        if (!(costs[i].rmse < best)) continue;
        best = costs[i].rmse;
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
