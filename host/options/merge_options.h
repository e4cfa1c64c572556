// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/image/encoding.h"

namespace rt {

/// `mirrorball merge`
struct MergeOptions {
    std::vector<std::string> parts;
    std::string output;  ///< empty: only look whether they fit
    Encoding encoding = Encoding::display;
    bool allow_missing = false;
    bool quiet = false;
};

}  // namespace rt
