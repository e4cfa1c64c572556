// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/measure/baseline.h"
#include "host/picture/render_settings.h"

namespace rt {

/// What to measure.
struct BenchOptions {
    std::vector<std::string> scenes;  ///< empty: the built-in scene
    std::vector<PictureSize> sizes{{100, 100}, {200, 200}, {300, 300}, {400, 400}, {500, 500}};
    std::vector<AaMode> aa;
    std::vector<std::string> devices{"all"};
    int threads = 0;  ///< "threads" runs with 1 to this many; 0: all cores
    std::vector<Precision> precisions{Precision::float32, Precision::float64};
    std::vector<Schedule> schedules{Schedule::tiles, Schedule::buffers};
    bool scalar = true;  ///< also threads without vectors: one ray at a time
    LightOverrides light;
    int repeats = 5;      ///< not counting the warm-up
    bool ablate = false;  ///< measure what leaving features out saves, instead of devices
    bool quiet = false;
};

/// Measures. With a baseline, throws Error (ExitCode::input) before that if no row is in it.
BenchResult measure_bench(const BenchOptions& options, const Baseline* baseline);

}  // namespace rt
