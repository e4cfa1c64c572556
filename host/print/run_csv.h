// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/picture/render_stats.h"

namespace rt {

/// The first line of the CSV of bench and converge, without its newline.
std::string run_csv_header();

/// What a CSV line holds besides the run itself.
struct RunPlace {
    std::string device;   ///< spec
    std::string verdict;  ///< of the row or point
    int round = 0;        ///< 0: warm-up; repeats from 1
};

/// One run as a line with its newline; text with a comma or a quote in it is quoted (RFC 4180).
std::string run_csv_line(const RenderStats& run, const RunPlace& place);

}  // namespace rt
