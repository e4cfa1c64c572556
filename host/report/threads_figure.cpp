// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

#include "host/report/html.h"
#include "host/report/labels.h"
#include "host/report/plots.h"

namespace rt {

namespace {

struct ThreadsCurves {
    PlotCurve measured, predicted;
};

void add_threads_row(ThreadsCurves& curves, const PlacedRow& placed) {
    const BenchFigures& figures = *placed.figures;
    if (!figures.speed_up || !figures.amdahl) return;
    const double threads = figures.threads;
    PlotPoint point = plain_point(
        threads, *figures.speed_up,
        fmt::format("{}: {} times as fast as one thread; Amdahl: {}", device_label(*placed.row),
                    significant(*figures.speed_up, 3), significant(*figures.amdahl, 3)),
        placed.source);
    const Spread& total = figures.total;
    const double base = *figures.speed_up * total.median;
    point.y_low = base / (total.median + total.mad);
    point.y_high = base / std::max(total.median - total.mad, total.median / 10);
    curves.measured.points.push_back(point);
    curves.predicted.points.push_back(plain_point(threads, *figures.amdahl, "", ""));
}

/// Shared tiles, the usual schedule, come first.
using CurvesBySchedule = std::map<std::string, ThreadsCurves, std::greater<>>;

CurvesBySchedule threads_curves(const std::vector<PlacedRow>& rows) {
    CurvesBySchedule curves;
    for (const PlacedRow& placed : largest_rows(rows)) {
        if (placed.row->asked.uses_threads && placed.row->asked.schedule != "scalar") {
            add_threads_row(curves[placed.row->asked.schedule], placed);
        }
    }
    return curves;
}

/// "2 threads are 1.95 times as fast as one (Amdahl's law: 1.98)."
std::string sentences(const CurvesBySchedule& curves) {
    std::string html;
    for (const auto& [schedule, pair] : curves) {
        if (pair.measured.points.size() < 2) continue;
        const PlotPoint& point = pair.measured.points.back();
        html += fmt::format(
            "<p{}>{:g} threads {}are {} times as fast as one (Amdahl's law: {}), counting the "
            "total time.</p>\n",
            html_attribute("data-source", point.source), point.x,
            schedule == "buffers" ? "with sample buffers " : "", significant(point.y, 3),
            significant(pair.predicted.points.back().y, 3));
    }
    return html;
}

Plot threads_plot(CurvesBySchedule all, std::size_t index) {
    Plot plot;
    plot.id = fmt::format("threads-{}", index);
    plot.title = "Speed-up against threads, measured and predicted by Amdahl's law";
    plot.x = {"threads", 0, 1, false, AxisUnit::count};
    plot.y = {"total: times as fast as one thread", 0, 1, false, AxisUnit::plain};
    int style = 0;
    for (auto& [schedule, curves] : all) {
        curves.measured.label = schedule == "buffers" ? "sample buffers" : "shared tiles";
        curves.predicted.label = "Amdahl, " + schedule;
        curves.predicted.is_prediction = true;
        curves.measured.color = curves.predicted.color = DeviceColors::threads;
        curves.measured.dash = curves.measured.marker = style++;
        plot.curves.push_back(curves.measured);
        plot.curves.push_back(curves.predicted);
    }
    fit_axes(plot);
    plot.description =
        "Linear axes. Amdahl's law takes the share of one thread's total time that "
        "is spent tracing as what threads can shorten.";
    return plot;
}

}  // namespace

std::string threads_html(const std::vector<PlacedRow>& rows, std::size_t index) {
    const auto curves = threads_curves(rows);
    std::size_t counts = 0;
    for (const auto& [schedule, pair] : curves) {
        counts = std::max(counts, pair.measured.points.size());
    }
    if (counts < 2) return "";
    std::string html = "<h3>Threads</h3>\n" + sentences(curves);
    if (counts == 2) return html;
    return html +
           plot_figure(threads_plot(curves, index),
                       "Dotted: Amdahl's law from the measured share of tracing in one thread's "
                       "total. Bands: median absolute deviation.");
}

}  // namespace rt
