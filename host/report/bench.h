// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/report/bench_result.h"
#include "host/report/statistics.h"

namespace rt {

const char* to_string(Verdict verdict);

/// What is measured of a right row. Every figure is of medians over its repeats.
struct BenchFigures {
    Spread trace, total;         ///< seconds
    double rays_per_second = 0;  ///< rays over the median trace seconds
    int threads = 0;             ///< that ran; 0 for OpenCL
    /// Total seconds of one thread over this row's: the same scene, size, AA and precision, in the
    /// same schedule (for OpenCL: tiles, else buffers). Empty when one thread was not measured.
    std::optional<double> speed_up;
    std::optional<double> parallel_fraction;  ///< of that one-thread row; empty for OpenCL
    std::optional<double> amdahl;             ///< the speed-up it predicts for these threads
    std::optional<double> over_amdahl;        ///< speed_up - amdahl
};

/// Empty unless the row is right and has a repeat: a wrong picture has no timing.
std::optional<BenchFigures> figures_of(const BenchResult& result, const BenchRow& row);

/// What a row is recognised by in another result: scene hash, size, AA, precision, device,
/// schedule.
std::string key_of(const BenchCase& asked);

/// Whether any row has this verdict.
bool any_row(const BenchResult& result, Verdict verdict);

}  // namespace rt
