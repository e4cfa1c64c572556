// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace rt {

/// Run time and error of one way to make a picture.
struct Cost {
    double seconds = 0, rmse = 0;
};

/// The Pareto front: ways for which no other is at least as fast and as accurate, and better in
/// one, to the three digits that tables show. Indices by increasing seconds, hence decreasing
/// error; of equals, the first.
std::vector<std::size_t> pareto_front(std::span<const Cost> costs);

/// The slope of log RMSE over log seconds, by least squares: -0.5 for plain random sampling. Costs
/// with a 0 are left out; empty when fewer than two different times remain.
std::optional<double> log_log_slope(std::span<const Cost> costs);

}  // namespace rt
