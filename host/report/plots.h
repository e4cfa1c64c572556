// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host/report/device_colors.h"
#include "host/report/rows.h"
#include "host/report/svg_plot.h"

namespace rt {

/// Stacked bars: where the time of the largest picture goes on each device; for OpenCL also in the
/// first round, if that rebuilt kernels.
std::string phases_figure(const std::vector<PlacedRow>& rows, const DeviceColors& colors);

/// Two plots against picture size: trace seconds of each device, and its speed-up over one thread.
std::string size_figures(const std::vector<PlacedRow>& rows, std::size_t index,
                         const DeviceColors& colors);

/// Measured speed-up against threads next to Amdahl's prediction: a plot for three or more thread
/// counts, a sentence for two, nothing for one.
std::string threads_html(const std::vector<PlacedRow>& rows, std::size_t index);

/// A plot with its caption (HTML, already escaped) as a figure.
std::string plot_figure(const Plot& plot, const std::string& caption);

/// A point without noise or label.
PlotPoint plain_point(double x, double y, const std::string& title, const std::string& source);

/// The axes that hold all points of the curves, ranges included.
void fit_axes(Plot& plot);

}  // namespace rt
