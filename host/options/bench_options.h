// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/options/render_options.h"

namespace rt {

/// Where results go besides the table: a file, "-" for stdout, or empty for nowhere.
struct ResultFiles {
    std::string json, csv;

    bool take_stdout() const { return json == "-" || csv == "-"; }
};

/// `mirrorball bench`
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
    int repeats = 5;  ///< not counting the warm-up
    ResultFiles results;
    std::string baseline;       ///< an earlier --json file; empty: none
    double max_regress = 0.05;  ///< allowed loss of a row, as a share of the old median
    bool ablate = false;        ///< measure what leaving features out saves, instead of devices
    bool quiet = false;
};

}  // namespace rt
