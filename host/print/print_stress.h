// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/stress/stress_result.h"

namespace rt {

/// A line per family: cases, worst figures, tolerance, verdict, why it matters; the broken cases
/// below their family. Verbose: a line per case and renderer.
std::string stress_text(const StressResult& result, bool verbose);

/// The names of the families and their cases; those of --quick are marked.
std::string stress_list(const std::vector<StressFamily>& families);

/// A tolerance in a few words: "0 wrong, 1e-04".
std::string tolerance_text(const StressTolerance& tolerance);

/// The loosest tolerance of a family's cases.
StressTolerance loosest_tolerance(const StressFamilyResult& family);

/// Format "mirrorball-stress", version 1 (docs/stress.schema.json).
std::string stress_json(const StressResult& result);

}  // namespace rt
