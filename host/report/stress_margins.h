// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "host/stress/stress_result.h"

namespace rt {

/// How much of its tolerance a family uses: the largest ratio of error to allowed error over its
/// judged rows. Empty where no number is compared (texts, families without a reference).
std::optional<double> used_tolerance(const StressFamilyResult& family);

/// Indices into result.families: failed ones first, then by decreasing used tolerance.
std::vector<std::size_t> by_margin(const StressResult& result);

}  // namespace rt
