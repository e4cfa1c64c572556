// SPDX-License-Identifier: Apache-2.0
#include "host/report/plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "host/report/html.h"
#include "host/report/labels.h"

namespace rt {

namespace {

std::string picture_text(const BenchCase& asked) {
    return fmt::format("{} x {} pixels, {}", asked.width, asked.height, to_string(asked.aa));
}

PlotPoint size_point(const PlacedRow& placed) {
    const Spread& trace = placed.figures->trace;
    const auto pixels = static_cast<double>(pixels_of(placed.row->asked));
    PlotPoint point;
    point.x = point.x_low = point.x_high = pixels;
    point.y = trace.median;
    point.y_low = std::max(trace.median - trace.mad, trace.median / 10);
    point.y_high = trace.median + trace.mad;
    point.title = fmt::format("{} on {}: {}", picture_text(placed.row->asked),
                              device_label(*placed.row), spread_text(trace));
    point.source = placed.source;
    return point;
}

/// The axes that hold all points of the curves, ranges included.
void fit_axes(Plot& plot) {
    std::vector<double> x, y;
    for (const PlotCurve& curve : plot.curves) {
        for (const PlotPoint& point : curve.points) {
            x.insert(x.end(), {point.x, point.x_low, point.x_high});
            y.insert(y.end(), {point.y, point.y_low, point.y_high});
        }
    }
    plot.x = axis_around(plot.x.label, x, plot.x.logarithmic, plot.x.unit);
    plot.y = axis_around(plot.y.label, y, plot.y.logarithmic, plot.y.unit);
}

struct ThreadsCurves {
    PlotCurve measured, predicted;
};

PlotPoint plain_point(double x, double y, const std::string& title, const std::string& source) {
    PlotPoint point;
    point.x = point.x_low = point.x_high = x;
    point.y = point.y_low = point.y_high = y;
    point.title = title;
    point.source = source;
    return point;
}

void add_threads_row(ThreadsCurves& curves, const PlacedRow& placed) {
    const BenchFigures& figures = *placed.figures;
    if (!figures.speed_up || !figures.amdahl) return;
    const double threads = figures.threads;
    PlotPoint point =
        plain_point(threads, *figures.speed_up,
                    fmt::format("{}: {} times one thread; Amdahl: {}", device_label(*placed.row),
                                significant(*figures.speed_up, 3), significant(*figures.amdahl, 3)),
                    placed.source);
    const Spread& total = figures.total;
    const double base = *figures.speed_up * total.median;
    point.y_low = base / (total.median + total.mad);
    point.y_high = base / std::max(total.median - total.mad, total.median / 10);
    point.label = significant(*figures.speed_up, 3) + "×";
    curves.measured.points.push_back(point);
    curves.predicted.points.push_back(plain_point(threads, *figures.amdahl, "", ""));
}

std::map<std::string, ThreadsCurves> threads_curves(const std::vector<PlacedRow>& rows) {
    std::map<std::string, ThreadsCurves> curves;
    for (const PlacedRow& placed : largest_rows(rows)) {
        if (placed.row->asked.uses_threads) {
            add_threads_row(curves[placed.row->asked.schedule], placed);
        }
    }
    return curves;
}

}  // namespace

std::string figure_html(const std::string& drawing, const std::string& title,
                        const std::string& legend, const std::string& caption) {
    return "<figure class=\"plot\"><div class=\"scroll\" tabindex=\"0\" role=\"region\"" +
           html_attribute("aria-label", title) + ">" + drawing + "</div>\n" + legend +
           "<figcaption>" + caption + "</figcaption></figure>\n";
}

std::string plot_figure(const Plot& plot, const std::string& caption) {
    return figure_html(svg_plot(plot), plot.title, plot_legend(plot), caption);
}

std::string size_figure(const std::vector<PlacedRow>& rows, std::size_t index) {
    const std::vector<PlacedRow> largest = largest_rows(rows);
    if (largest.empty()) return "";
    const AaMode aa = largest.front().row->asked.aa;
    Plot plot;
    plot.id = fmt::format("size-{}", index);
    plot.title = "Ray trace time against picture size";
    plot.x = {"pixels", 1, 10, true, AxisUnit::power};
    plot.y = {"ray trace time", 1, 10, true, AxisUnit::seconds};
    for (const PlacedRow& device : largest) {
        PlotCurve curve{device_label(*device.row),
                        static_cast<int>(plot.curves.size()),
                        static_cast<int>(plot.curves.size()),
                        {},
                        false};
        for (const PlacedRow& placed : rows) {
            if (placed.figures && placed.row->asked.aa == aa &&
                !placed.row->asked.double_precision && device_label(*placed.row) == curve.label) {
                curve.points.push_back(size_point(placed));
            }
        }
        std::sort(curve.points.begin(), curve.points.end(),
                  [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; });
        plot.curves.push_back(curve);
    }
    if (plot.curves.front().points.size() < 2) return "";
    fit_axes(plot);
    plot.description =
        "Both axes logarithmic; a straight line of slope 1 costs the same for every "
        "pixel. The numbers are in the tables above.";
    return "<h3>Time against size</h3>\n" +
           plot_figure(plot, html_text(fmt::format("{}, float. Bands: median absolute deviation.",
                                                   to_string(aa))));
}

std::string threads_figure(const std::vector<PlacedRow>& rows, std::size_t index) {
    Plot plot;
    plot.id = fmt::format("threads-{}", index);
    plot.title = "Speed-up against threads, measured and after Amdahl";
    plot.x = {"threads", 0, 1, false, AxisUnit::count};
    plot.y = {"times as fast as one thread", 0, 1, false, AxisUnit::plain};
    int style = 0;
    for (auto& [schedule, curves] : threads_curves(rows)) {
        if (curves.measured.points.size() < 2) continue;
        const std::string name =
            schedule == "buffers" ? "a thread per sample buffer" : "shared tiles";
        curves.measured.label = name + ", measured";
        curves.predicted.label = name + ", Amdahl's law";
        curves.predicted.is_prediction = true;
        curves.measured.color = curves.predicted.color = style;
        curves.measured.shape = style++;
        plot.curves.push_back(curves.measured);
        plot.curves.push_back(curves.predicted);
    }
    if (plot.curves.empty()) return "";
    fit_axes(plot);
    plot.description =
        "Linear axes. Amdahl's law takes the share of one thread's total time that "
        "is spent tracing as what threads can shorten.";
    return "<h3>Threads</h3>\n" +
           plot_figure(
               plot, html_text(picture_text(largest_rows(rows).front().row->asked) +
                               ", float, total time. Dotted: Amdahl's law from the measured share "
                               "of tracing in one thread's total. Bands: median absolute "
                               "deviation."));
}

}  // namespace rt
