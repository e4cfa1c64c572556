// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace rt {

/// `mirrorball stress`
struct StressOptions {
    std::vector<std::string> cases;   ///< globs; empty: all
    std::vector<std::string> except;  ///< globs
    std::vector<std::string> devices{"all"};
    bool quick = false;         ///< the cases and ray counts that take under a minute
    bool all_features = false;  ///< one build of the kernels for all cases; quick implies it
    bool list = false;          ///< name the cases, run none
    std::string json;           ///< empty: none; "-": stdout
    std::string output;         ///< folder for pictures; empty: none
    bool quiet = false, verbose = false;
};

}  // namespace rt
