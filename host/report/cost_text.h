// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/stress/stress_result.h"

namespace rt {

/// A block per scene and renderer: for each technique the textbook's way, its time, and the robust
/// renderer's time over it.
std::string cost_text(const std::vector<CostTable>& tables);

}  // namespace rt
