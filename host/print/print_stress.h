// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/stress/judge.h"

namespace rt {

/// The verdict, then a line per family: its worst figures next to what is allowed, the broken cases
/// below. Verbose: also why a family matters, and a line per case and renderer.
std::string stress_text(const StressResult& result, bool verbose);

/// The names of the families and their cases; those of --quick are marked.
std::string stress_list(const std::vector<StressFamily>& families);

}  // namespace rt
