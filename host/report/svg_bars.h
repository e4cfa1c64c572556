// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace rt {

/// A part of a bar; parts of the same `style` in all bars are of one kind.
struct BarPart {
    std::string label;
    double seconds = 0;
    int style = 0;
};

struct Bar {
    std::string label;
    std::string source;  ///< where its numbers come from, for data-source
    std::vector<BarPart> parts;
};

/// Stacked horizontal bars on one axis of seconds, each with its total written at its end.
struct BarChart {
    std::string id, title, description;
    std::vector<Bar> bars;
};

std::string svg_bars(const BarChart& chart);

/// The kinds of parts that are there, with their colors, as an HTML list.
std::string bars_legend(const BarChart& chart);

}  // namespace rt
