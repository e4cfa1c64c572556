// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/measure/converge_result.h"

namespace rt {

/// A header and a line per run, warm-up (round 0) and repeats.
std::string converge_csv(const ConvergeResult& result);

}  // namespace rt
