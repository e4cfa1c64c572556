// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host/report/rows.h"
#include "host/report/svg_plot.h"

namespace rt {

/// Stacked bars: where the time of the largest picture goes, device by device; for OpenCL also in
/// the first round, where that built kernels anew.
std::string phases_figure(const std::vector<PlacedRow>& rows, std::size_t index);

/// Trace seconds against pixels, a curve a device.
std::string size_figure(const std::vector<PlacedRow>& rows, std::size_t index);

/// Measured speed-up against threads beside Amdahl's prediction; empty without two thread counts.
std::string threads_figure(const std::vector<PlacedRow>& rows, std::size_t index);

/// A drawing named by its title, with its legend and caption (both HTML), as a figure.
std::string figure_html(const std::string& drawing, const std::string& title,
                        const std::string& legend, const std::string& caption);

/// A plot with its legend and caption (HTML, already escaped) as a figure.
std::string plot_figure(const Plot& plot, const std::string& caption);

}  // namespace rt
