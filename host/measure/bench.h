// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/measure/bench_result.h"
#include "host/measure/statistics.h"

namespace rt {

/// Figures of a right row, each computed from medians over its repeats.
struct BenchFigures {
    Spread trace, total;         ///< seconds
    double rays_per_second = 0;  ///< rays over the median trace seconds
    int threads = 0;             ///< that ran; 0 for OpenCL
    /// Total seconds of one thread over this row's: the same scene, size, AA and precision, in the
    /// same schedule (for OpenCL: tiles, else buffers). Empty when one thread was not measured.
    std::optional<double> speed_up;
    std::optional<double> trace_speed_up;     ///< the same of trace seconds
    std::optional<double> parallel_fraction;  ///< of that one-thread row; empty for OpenCL
    std::optional<double> amdahl;             ///< the speed-up it predicts for these threads
    std::optional<double> over_amdahl;        ///< speed_up - amdahl
};

/// Empty unless the row is right and has a repeat: a wrong picture has no timing.
std::optional<BenchFigures> figures_of(const BenchResult& result, const BenchRow& row);

/// Figures of a row of an ablation.
struct AblationFigures {
    Spread trace;            ///< seconds
    double first_build = 0;  ///< seconds to build the kernels before the first picture
    double ratio = 0;        ///< median trace over that of the usual row: above 1, slower
};

/// The usual row that this row of result.ablation is a variation of; the row itself if it is one.
const BenchRow& usual_row(const BenchResult& result, const BenchRow& row);

/// Empty unless the row and the usual one are right and have a repeat.
std::optional<AblationFigures> ablation_figures(const BenchResult& result, const BenchRow& row);

/// Marks rows of the ablation whose picture differs from the usual one as wrong.
void judge_ablation(BenchResult& result);

/// Identifies a row across results: scene hash, size, AA, precision, device, schedule.
std::string key_of(const BenchCase& asked);

/// Whether any row has this verdict.
bool any_row(const BenchResult& result, Verdict verdict);

}  // namespace rt
