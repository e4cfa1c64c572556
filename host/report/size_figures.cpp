// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/report/html.h"
#include "host/report/labels.h"
#include "host/report/plots.h"

namespace rt {

namespace {

// Dashes and markers of threads: most threads, one thread, sample buffers, scalar.
constexpr int most_threads_style = 0, one_thread_style = 1, buffers_style = 2, scalar_style = 3;

/// The side of a square with as many pixels.
double side_of(const BenchCase& asked) { return std::sqrt(static_cast<double>(pixels_of(asked))); }

std::string size_label(const BenchCase& asked) {
    return asked.width == asked.height ? fmt::format("{}²", asked.width)
                                       : fmt::format("{}×{}", asked.width, asked.height);
}

PlotPoint time_point(const PlacedRow& placed) {
    const Spread& trace = placed.figures->trace;
    PlotPoint point = plain_point(side_of(placed.row->asked), trace.median,
                                  fmt::format("{} on {}: {}", size_label(placed.row->asked),
                                              device_label(*placed.row), spread_text(trace)),
                                  placed.source);
    point.y_low = std::max(trace.median - trace.mad, trace.median / 10);
    point.y_high = trace.median + trace.mad;
    return point;
}

PlotPoint ratio_point(const PlacedRow& placed) {
    const double ratio = *placed.figures->trace_speed_up;
    return plain_point(
        side_of(placed.row->asked), ratio,
        fmt::format("{} on {}: {} times as fast as one thread", size_label(placed.row->asked),
                    device_label(*placed.row), significant(ratio, 3)),
        placed.source);
}

int style_of(const BenchCase& asked) {
    if (!asked.uses_threads) return 0;
    if (asked.schedule == "buffers") return buffers_style;
    if (asked.schedule == "scalar") return scalar_style;
    return asked.threads == 1 ? one_thread_style : most_threads_style;
}

/// The largest picture's rows that get a curve: OpenCL, the most threads, and one thread with and
/// without vectors.
std::vector<PlacedRow> drawn_devices(const std::vector<PlacedRow>& rows) {
    std::vector<PlacedRow> devices = largest_rows(rows);
    int most = 1;
    for (const PlacedRow& placed : devices) most = std::max(most, placed.row->asked.threads);
    std::erase_if(devices, [&](const PlacedRow& placed) {
        const BenchCase& asked = placed.row->asked;
        if (asked.schedule == "scalar") return asked.threads != 1;
        return asked.uses_threads && asked.threads != most &&
               (asked.threads != 1 || asked.schedule == "buffers");
    });
    return devices;
}

/// One device across the sizes, with the sampling and precision of its largest picture.
template <typename MakePoint>
PlotCurve curve_of(const std::vector<PlacedRow>& rows, const PlacedRow& device,
                   const DeviceColors& colors, MakePoint make_point) {
    const BenchCase& like = device.row->asked;
    PlotCurve curve{device_label(*device.row), colors.of(like), style_of(like), style_of(like)};
    for (const PlacedRow& placed : rows) {
        const BenchCase& asked = placed.row->asked;
        if (placed.figures && asked.aa == like.aa && !asked.double_precision &&
            asked.device == like.device && asked.schedule == like.schedule) {
            curve.points.push_back(make_point(placed));
        }
    }
    std::sort(curve.points.begin(), curve.points.end(),
              [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; });
    return curve;
}

void name_sizes(Plot& plot, const std::vector<PlacedRow>& rows) {
    for (const PlacedRow& placed : rows) {
        const Tick tick{side_of(placed.row->asked), size_label(placed.row->asked)};
        const bool known = std::any_of(plot.x.ticks.begin(), plot.x.ticks.end(),
                                       [&](const Tick& t) { return t.label == tick.label; });
        if (!known) plot.x.ticks.push_back(tick);
    }
}

std::string time_figure(const std::vector<PlacedRow>& rows, std::size_t index,
                        const DeviceColors& colors) {
    Plot plot;
    plot.id = fmt::format("size-{}", index);
    plot.title = "Ray trace time against picture size";
    plot.x = {"pixels", 1, 10, true, AxisUnit::plain};
    plot.y = {"ray trace time", 1, 10, true, AxisUnit::seconds};
    for (const PlacedRow& device : drawn_devices(rows)) {
        const BenchCase& asked = device.row->asked;
        if (asked.schedule == "buffers") continue;  // coincides with shared tiles: see the ratios
        plot.curves.push_back(curve_of(rows, device, colors, time_point));
    }
    if (plot.curves.empty() || plot.curves.front().points.size() < 2) return "";
    fit_axes(plot);
    name_sizes(plot, rows);
    plot.description = "Both axes logarithmic. The numbers are in the tables above.";
    return plot_figure(plot, "Bands: median absolute deviation.");
}

double lowest_y(const Plot& plot) {
    double lowest = plot.y.high;
    for (const PlotCurve& curve : plot.curves) {
        for (const PlotPoint& point : curve.points) lowest = std::min(lowest, point.y);
    }
    return lowest;
}

std::string ratio_figure(const std::vector<PlacedRow>& rows, std::size_t index,
                         const DeviceColors& colors) {
    Plot plot;
    plot.id = fmt::format("size-ratio-{}", index);
    plot.title = "Ray trace speed-up over one thread against picture size";
    plot.x = {"pixels", 1, 10, true, AxisUnit::plain};
    plot.y = {"tracing: times as fast as one thread", 0, 1, false, AxisUnit::plain};
    for (const PlacedRow& device : drawn_devices(rows)) {
        const BenchCase& asked = device.row->asked;
        if (!device.figures->trace_speed_up || asked.threads == 1) continue;
        plot.curves.push_back(curve_of(rows, device, colors, ratio_point));
    }
    if (plot.curves.empty() || plot.curves.front().points.size() < 2) return "";
    PlotCurve one{"1 thread", DeviceColors::threads, 0, 0};
    for (const PlotPoint& point : plot.curves.front().points) {
        one.points.push_back(plain_point(point.x, 1, "", ""));
    }
    one.is_prediction = true;
    plot.curves.push_back(one);
    fit_axes(plot);
    plot.y.low = lowest_y(plot) / 1.1;  // ratios need no axis from 0
    name_sizes(plot, rows);
    plot.description = "Sizes on a logarithmic axis. The numbers are in the table of all settings.";
    return plot_figure(plot, "Tracing time of one thread over tracing time of the device.");
}

}  // namespace

std::string size_figures(const std::vector<PlacedRow>& rows, std::size_t index,
                         const DeviceColors& colors) {
    const std::string time = time_figure(rows, index, colors);
    if (time.empty()) return "";
    const std::vector<PlacedRow> largest = largest_rows(rows);
    const std::string sampling = sampling_text(largest.front().row->asked.aa);
    return fmt::format("<h3>Time against size</h3>\n<p>In float, {}.</p>\n<div class=\"plots\">\n",
                       html_text(sampling)) +
           time + ratio_figure(rows, index, colors) + "</div>\n";
}

}  // namespace rt
