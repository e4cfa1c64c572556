// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/stress/case_helpers.h"

namespace rt {

// The scene scaled or moved. The first and last of these must not change a bit of its picture.

/// By 2^k.
StressCase scaled_by_two(const MakeScene& scene, int k);

/// By 10^k.
StressCase scaled_by_ten(const MakeScene& scene, int k);

/// By whole numbers: `by` and up to twice that.
StressCase moved(const MakeScene& scene, std::string label, double by);

}  // namespace rt
