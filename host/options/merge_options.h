// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/image/encoding.h"
#include "host/image/picture_format.h"

namespace rt {

/// `mirrorball merge`
struct MergeOptions {
    std::vector<std::string> parts;
    std::string output;  ///< empty: only check whether they fit; "-": standard output
    std::optional<PictureFormat> format;  ///< of standard output
    Encoding encoding = Encoding::display;
    bool allow_missing = false;
    double verify = 0;  ///< share of the picture to render again on threads and compare, 0 to 1
    std::string scene;  ///< for `verify`; empty: the file that the first part names
    bool quiet = false;
};

}  // namespace rt
