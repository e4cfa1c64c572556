// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "host/measure/converge.h"
#include "host/report/html.h"
#include "host/report/labels.h"
#include "host/report/plots.h"
#include "host/report/sections.h"

namespace rt {

namespace {

std::string point_source(std::size_t index, std::size_t point) {
    return fmt::format("converge-{}#/points/{}", index, point);
}

std::string device_text(const ConvergePoint& point) {
    std::string text =
        point.repeats.empty() ? point.asked.device_name : device_label(point.repeats.front());
    text += point.asked.double_precision ? ", double" : ", float";
    return text + (point.asked.fast_math ? ", fast math" : "");
}

/// Seconds to open the device and rebuild the kernels of a point; 0 if there are none.
double build_seconds(const ConvergeResult& result, const ConvergeCase& asked) {
    for (const BuildOffset& offset : build_offsets(result)) {
        if (offset.of.device == asked.device && offset.of.fast_math == asked.fast_math &&
            offset.of.double_precision == asked.double_precision) {
            return offset.first_build > 0 ? offset.open + offset.first_build : 0;
        }
    }
    return 0;
}

PlotPoint plot_point(const ConvergeResult& result, std::size_t i, std::size_t index) {
    const ConvergePoint& measured = result.points[i];
    const PointFigures figures = *figures_of(result, measured);
    PlotPoint point;
    point.x = figures.seconds.median;
    point.x_low = std::max(point.x - figures.seconds.mad, point.x / 10);
    point.x_high = point.x + figures.seconds.mad;
    point.y = point.y_low = point.y_high = figures.rmse;
    point.title =
        fmt::format("{} on {}: {}, RMSE {}", to_string(measured.asked.aa), device_text(measured),
                    spread_text(figures.seconds), scientific_text(figures.rmse));
    point.source = point_source(index, i);
    return point;
}

/// A family's index among the known ones; adds it if it is new.
int place_of(std::vector<std::string>& known, const std::string& name) {
    const auto at = std::find(known.begin(), known.end(), name);
    if (at != known.end()) return static_cast<int>(at - known.begin());
    known.push_back(name);
    return static_cast<int>(known.size()) - 1;
}

std::string short_device(const ConvergePoint& point) {
    return point.repeats.empty() ? point.asked.device_name : device_label(point.repeats.front());
}

bool has_float(const ConvergeResult& result) {
    return std::any_of(result.points.begin(), result.points.end(),
                       [](const ConvergePoint& p) { return !p.asked.double_precision; });
}

/// Color is the device, dash and marker the kind of sampling; double precision has hollow markers
/// and, where there is float, no label.
std::vector<PlotCurve> plot_curves(const ConvergeResult& result, const DeviceColors& colors,
                                   std::size_t index) {
    std::vector<PlotCurve> curves;
    std::vector<std::string> families;
    const bool names_double = !has_float(result);
    const std::vector<std::size_t> front = front_of(result);
    for (const Curve& measured : curves_of(result)) {
        const ConvergePoint& first = result.points[measured.points.front()];
        PlotCurve curve;
        curve.is_hollow = first.asked.double_precision;
        if (!curve.is_hollow || names_double) {
            curve.label = short_device(first) + " " + measured.family;
        }
        curve.color = colors.of(first.asked);
        curve.dash = curve.marker = place_of(families, measured.family);
        for (const std::size_t i : measured.points) {
            curve.points.push_back(plot_point(result, i, index));
            const bool is_best = std::find(front.begin(), front.end(), i) != front.end();
            if (is_best) curve.points.back().label = to_string(result.points[i].asked.aa);
        }
        std::sort(curve.points.begin(), curve.points.end(),
                  [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; });
        const double build = build_seconds(result, measured.of);
        if (build > 0) curve.points.front().x_with_build = curve.points.front().x + build;
        curves.push_back(curve);
    }
    return curves;
}

Plot error_time_plot(const ConvergeResult& result, const DeviceColors& colors, std::size_t index) {
    Plot plot;
    plot.id = fmt::format("error-time-{}", index);
    plot.title = "Error against run time";
    plot.curves = plot_curves(result, colors, index);
    for (const std::size_t i : front_of(result)) {
        plot.front.push_back(plot_point(result, i, index));
    }
    std::vector<double> x, y{result.reference.floor()};
    for (const PlotCurve& curve : plot.curves) {
        for (const PlotPoint& point : curve.points) {
            x.insert(x.end(), {point.x_low, point.x_high});
            y.push_back(point.y);
        }
    }
    plot.x = axis_around("run time of a picture", x, true, AxisUnit::seconds);
    plot.y = axis_around("RMSE against the converged picture", y, true, AxisUnit::power);
    plot.floor = result.reference.floor();
    plot.floor_label = "below the reference's own noise";
    plot.description = fmt::format(
        "Both axes logarithmic: {} curves, each a device and precision with one kind of sampling, "
        "falling to the right. The numbers are in the tables below.",
        plot.curves.size());
    return plot;
}

std::string front_table(const ConvergeResult& result, std::size_t index) {
    HtmlTable table{"Pareto front: no other setting is both faster and more accurate",
                    {"sampling", "device", "run time, ms", "noise, %", "RMSE"},
                    {}};
    for (const std::size_t i : front_of(result)) {
        const ConvergePoint& point = result.points[i];
        const PointFigures figures = *figures_of(result, point);
        table.rows.push_back({{to_string(point.asked.aa), point_source(index, i)},
                              {device_text(point), ""},
                              {milliseconds(figures.seconds.median), ""},
                              {significant(figures.seconds.noise_percent(), 2), ""},
                              {scientific_text(figures.rmse, 3), ""}});
    }
    return html_table(table);
}

/// The device's label in other tables and plots, if it has rendered anything.
std::string name_of(const ConvergeResult& result, const std::string& device,
                    const std::string& device_name) {
    for (const ConvergePoint& point : result.points) {
        if (point.asked.device == device && !point.repeats.empty()) return short_device(point);
    }
    return device_name;
}

std::string targets_table(const ConvergeResult& result, std::size_t index) {
    HtmlTable table{
        "Time to reach an error, with the fastest setting that reaches it", {"device"}, {}};
    for (const double target : rmse_targets) {
        table.heads.push_back("RMSE " + significant(target, 1));
    }
    std::string device;
    for (const TargetTime& time : target_times(result)) {
        if (table.rows.empty() || time.device != device) {
            table.rows.push_back({{name_of(result, time.device, time.device_name), ""}});
            device = time.device;
        }
        HtmlCell cell{time.below_floor ? "below the floor" : "not reached", ""};
        if (time.point) {
            const ConvergePoint& point = result.points[*time.point];
            cell = {fmt::format("{} ({})", duration_text(time.seconds), to_string(point.asked.aa)),
                    point_source(index, *time.point)};
        }
        table.rows.back().push_back(cell);
    }
    return html_table(table);
}

/// How fast each kind of sampling converges; one row per device and precision.
std::string slopes_table(const ConvergeResult& result) {
    HtmlTable table{"Slope of log RMSE over log time", {"device"}, {}};
    for (const Curve& curve : curves_of(result)) {
        if (!curve.slope) continue;
        const std::string device = device_text(result.points[curve.points.front()]);
        const auto head = std::find(table.heads.begin(), table.heads.end(), curve.family);
        const auto column = static_cast<std::size_t>(head - table.heads.begin());
        if (head == table.heads.end()) table.heads.push_back(curve.family);
        if (table.rows.empty() || table.rows.back()[0].text != device) {
            table.rows.push_back({{device, ""}});
        }
        auto& cells = table.rows.back();
        if (cells.size() <= column) cells.resize(column + 1);
        cells[column].text = fmt::format("{:.2f}", *curve.slope);
    }
    return table.rows.empty() ? "" : html_table(table);
}

std::string reference_text(const ConvergeReference& reference) {
    return fmt::format(
        "Two independent pictures in double precision ({} and {}) lie RMSE {} apart; their mean, "
        "the reference, is known to about {}: the shaded zone.",
        reference.aa_a, reference.aa_b, scientific_text(reference.halves_rmse),
        scientific_text(reference.floor()));
}

}  // namespace

std::string error_time_section(const ReportScene& scene, std::size_t index) {
    const ConvergeResult& result = scene.converge;
    if (curves_of(result).empty()) return "";
    const std::string source = fmt::format("converge-{}#/reference", index);
    return fmt::format("<h3>Error against run time</h3>\n<p{}>{}</p>\n",
                       html_attribute("data-source", source),
                       html_text(reference_text(result.reference))) +
           plot_figure(
               error_time_plot(result, DeviceColors(scene.bench.rows), index),
               html_text(fmt::format(
                   "{} pixels, medians of {} repeats; bands: median absolute deviation. "
                   "Hollow markers: double precision. A dotted whisker at a curve's first point "
                   "leads to the time that includes opening the device and building its kernels, "
                   "which is paid once; it ends at the frame if that time is beyond it. Run time: "
                   "flatten, upload, trace, resolve, read back. Values clamped to 0 to 1.",
                   size_text(result.width, result.height), result.repeats_asked))) +
           front_table(result, index) + targets_table(result, index) + slopes_table(result);
}

}  // namespace rt
