// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace rt {

/// A part of a bar; parts with the same `shade` are of one kind in all bars.
struct BarPart {
    std::string label;
    double seconds = 0;
    int shade = 0;
};

struct Bar {
    std::string label;
    std::string source;  ///< where its numbers come from, for data-source
    int color = 0;       ///< as DeviceColors says
    double total = 0;    ///< seconds, shown beside the name
    std::vector<BarPart> parts;
};

/// Stacked horizontal bars on a common axis of seconds, as HTML that fits any width: each with its
/// name and total above, and its parts, with names and times, below. Parts under half a percent of
/// their bar are merged into "other", which is left out where it is under a tenth of a percent.
std::string bars_html(const std::string& title, const std::vector<Bar>& bars);

}  // namespace rt
