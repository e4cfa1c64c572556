// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/report/plot_axis.h"

namespace rt {

/// A measured point: the value drawn, and the noise range of the repeats along the measured axis
/// (equal ends along the other).
struct PlotPoint {
    double x = 0, y = 0;
    double x_low = 0, x_high = 0;
    double y_low = 0, y_high = 0;
    std::string label;                   ///< beside the point; empty: none
    std::string title;                   ///< tooltip: what it is, with numbers
    std::string source;                  ///< where the value comes from, for data-source
    std::optional<double> x_with_build;  ///< where x would be with kernels rebuilt
};

/// Points of one kind, joined by a line.
struct PlotCurve {
    std::string label;  ///< written beside it; empty: none
    int color = 0;      ///< of plot_styles: the device, as DeviceColors says
    int dash = 0;       ///< of plot_styles: distinguishes curves of one device
    int marker = 0;     ///< of plot_styles
    std::vector<PlotPoint> points = {};
    bool is_prediction = false;  ///< a thin line without markers
    bool is_hollow = false;      ///< outlined markers on a thin line
};

struct Plot {
    std::string id;     ///< unique in the page
    std::string title;  ///< one line, for screen readers; also starts the alt text
    std::string description;
    Axis x, y;
    std::vector<PlotCurve> curves;
    std::vector<PlotPoint> front;  ///< a step line: the lowest y reached up to x
    std::string front_label = "Pareto front";
    std::optional<double> floor;  ///< y below this is meaningless
    std::string floor_label;
};

inline constexpr int plot_styles = 8;

/// The plot as inline SVG, each curve labeled. Colors and dashes come from the page's classes s0 to
/// s7 and d0 to d7.
std::string svg_plot(const Plot& plot);

}  // namespace rt
