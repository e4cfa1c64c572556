// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "host/measure/bench.h"

namespace rt {

/// What an earlier bench measured for a row with verdict right.
struct BaselineRow {
    Spread trace, total;  ///< seconds
};

/// By key_of.
using Baseline = std::map<std::string, BaselineRow>;

/// Reads the JSON of an earlier bench. Throws Error (ExitCode::input).
Baseline load_baseline(const std::string& path);

/// Whether a row has become slower: its median exceeds the old one by more than the fraction
/// `max_regress`, and by more than 3 times the summed MADs, so that noise alone does not count.
bool is_slower(const Spread& before, const Spread& now, double max_regress);

/// A row that has become slower.
struct Regression {
    std::string key;
    std::string what;  ///< "trace" or "total"
    Spread before, now;
};

/// One line: what, from, to, and the noise.
std::string to_string(const Regression& regression);

/// Throws Error (ExitCode::input) if none of the rows to be measured is in the baseline.
void check_baseline(const std::vector<BenchCase>& rows, const Baseline& baseline);

/// The rows of the result that are in the baseline and slower now, in total or else in trace.
std::vector<Regression> regressions(const BenchResult& result, const Baseline& baseline,
                                    double max_regress);

}  // namespace rt
