// SPDX-License-Identifier: Apache-2.0
#include "host/report/stress_margins.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace rt {

std::optional<double> used_tolerance(const StressFamilyResult& family) {
    std::optional<double> most;
    for (const StressCaseResult& one : family.cases) {
        for (const StressRow& row : one.rows) {
            if (!row.judged || row.refused + row.rendered > 0) continue;
            const double error = row.rays ? row.rays->max_error : row.figures.max_error;
            if (one.tolerance.max_error > 0)
                most = std::max(most.value_or(0), error / one.tolerance.max_error);
        }
    }
    return most;
}

std::vector<std::size_t> by_margin(const StressResult& result) {
    std::vector<std::size_t> order(result.families.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto rank = [&](std::size_t i) {
        const StressFamilyResult& family = result.families[i];
        return std::pair{family.passed(), -used_tolerance(family).value_or(-1)};
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
    return order;
}

}  // namespace rt
