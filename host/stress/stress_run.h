// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/stress/judge.h"

namespace rt {

struct RenderCache;

/// What to run.
struct StressOptions {
    std::vector<std::string> cases;   ///< globs; empty: all
    std::vector<std::string> except;  ///< globs
    std::vector<std::string> devices{"all"};
    bool quick = false;         ///< the cases and ray counts that take under a minute
    bool all_features = false;  ///< one build of the kernels for all cases; quick implies it
    std::string output;         ///< folder for pictures; empty: none
    bool quiet = false;
};

/// Runs the families' cases on the devices that the options name, threads and OpenCL, in float and
/// in double; the cache keeps what is built for the next call. Stops early, with `interrupted` on,
/// at a stop signal. Throws Error: usage or device for the devices, output for pictures.
StressResult run_stress_cases(const std::vector<StressFamily>& families,
                              const StressOptions& options, RenderCache& cache);

}  // namespace rt
