// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "host/base/text.h"
#include "host/print/print_stress.h"
#include "host/report/html.h"
#include "host/report/labels.h"
#include "host/report/plots.h"
#include "host/report/sections.h"
#include "host/report/stress_margins.h"

namespace rt {

namespace {

/// Families whose parameter is a number that spans decades.
constexpr std::array<std::string_view, 16> plotted_families{
    "scale-2",   "shift-odd",       "sphere-size",    "cone-size",    "cone-needle", "flat-cone",
    "long-cone", "huge-ball-floor", "facing-mirrors", "glass-depth",  "light-pipe",  "shininess",
    "highlight", "field-of-view",   "needles",        "huge-triangle"};

constexpr double least_error = 1e-9;  ///< smallest drawn; a picture's values are floats

std::string family_source(std::size_t family) { return fmt::format("stress#/families/{}", family); }

std::string figures_text(const PictureFigures& figures) {
    std::string text =
        fmt::format("{} wrong, {}", figures.wrong, scientific_text(figures.max_error));
    if (figures.nans > 0) text += fmt::format(", {} NaN", figures.nans);
    return text;
}

/// Milliseconds spent tracing all cases in float, on threads; "" if none.
std::string time_text(const StressFamilyResult& family) {
    double seconds = 0;
    for (const StressCaseResult& one : family.cases) {
        for (const StressRow& row : one.rows) {
            if (row.device == "threads" && !row.double_precision) seconds += row.seconds;
        }
    }
    return seconds == 0 ? "" : milliseconds(seconds);
}

/// The largest error allowed, and the other limits unless they are the usual "no wrong pixel".
std::string allowed_text(const StressTolerance& tolerance) {
    const bool usual = tolerance.most_wrong == 0 &&
                       tolerance.most_wrong_at_edges == StressTolerance{}.most_wrong_at_edges;
    return usual ? scientific_text(tolerance.max_error, 1) : tolerance_text(tolerance);
}

/// Used tolerance as a share of a bar's length, which spans six decades.
double drawn_length(double used) { return used > 0 ? 1 + std::log10(used) / 6 : 0; }

HtmlCell margin_cell(const StressFamilyResult& family) {
    const auto used = used_tolerance(family);
    if (!used) return {"–", ""};
    return {significant(100 * *used, 2) + " %", "", false, drawn_length(*used)};
}

std::vector<HtmlCell> verdict_row(const StressFamilyResult& family, std::size_t index) {
    const PictureFigures worst = worst_figures(family);
    return {{family.name, family_source(index)},
            {family.passed() ? "pass" : "fail", "", !family.passed()},
            margin_cell(family),
            {scientific_text(worst.max_error), ""},
            {allowed_text(loosest_tolerance(family)), ""},
            {std::to_string(worst.wrong), ""},
            {time_text(family), ""},
            {family.why, ""}};
}

std::string verdicts_table(const StressResult& result) {
    HtmlTable table{
        "Families by how much of their tolerance they use (bars: six decades, full at 100 %). "
        "Worst of every family's cases and renderers, float and double; times on threads, in float",
        {"family", "verdict", "tolerance used", "error", "tolerance", "wrong", "ms",
         "typical failure"},
        {}};
    for (const std::size_t i : by_margin(result)) {
        table.rows.push_back(verdict_row(result.families[i], i));
    }
    return "<div class=\"dense\">" + html_table(table) + "</div>\n";
}

/// "PASS: 59 of 59 families; needles comes closest to its tolerance, at 43 % of it."
std::string stress_verdict(const StressResult& result) {
    const auto passed = static_cast<std::size_t>(
        std::count_if(result.families.begin(), result.families.end(),
                      [](const StressFamilyResult& family) { return family.passed(); }));
    std::string text = fmt::format("{}: {} of {} families", result.passed() ? "PASS" : "FAIL",
                                   passed, result.families.size() + result.unfinished);
    const std::vector<std::size_t> order = by_margin(result);
    const StressFamilyResult& closest = result.families[order.front()];
    if (const auto used = used_tolerance(closest); used && closest.passed()) {
        text += fmt::format("; {} comes closest to its tolerance, at {} % of it", closest.name,
                            significant(100 * *used, 2));
    }
    return text + ".";
}

/// One renderer at one precision through a family's cases.
PlotCurve error_curve(const StressFamilyResult& family, std::size_t index, std::size_t row) {
    PlotCurve curve;
    for (std::size_t i = 0; i < family.cases.size(); ++i) {
        const StressCaseResult& one = family.cases[i];
        if (row >= one.rows.size() || !(one.value > 0)) continue;
        const StressRow& measured = one.rows[row];
        const double error = std::min(1.0, measured.figures.max_error);
        PlotPoint point;
        point.x = point.x_low = point.x_high = one.value;
        point.y = point.y_low = point.y_high = std::max(least_error, error);
        point.title = fmt::format("{} at {}: {}", measured.renderer, one.label,
                                  figures_text(measured.figures));
        point.source = fmt::format("{}/cases/{}/rows/{}", family_source(index), i, row);
        curve.points.push_back(point);
    }
    std::sort(curve.points.begin(), curve.points.end(),
              [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; });
    return curve;
}

/// One device stands for all: in strict arithmetic their pictures are the same.
Plot family_plot(const StressFamilyResult& family, std::size_t index) {
    Plot plot;
    plot.id = "stress-" + family.name;
    plot.title = fmt::format("Largest error against the {}: {}", family.parameter, family.name);
    plot.description =
        "Both axes logarithmic; away from edges, values clamped to 0 to 1; NaN counts as 1.";
    std::vector<double> values, errors{least_error, 1.0};
    const std::vector<StressRow>& rows = family.cases.front().rows;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        if (rows[row].device != rows.front().device) continue;
        PlotCurve curve = error_curve(family, index, row);
        curve.label = precision_name(rows[row].double_precision);
        curve.color = DeviceColors::no_device;
        curve.dash = curve.marker = rows[row].double_precision ? 1 : 0;
        for (const PlotPoint& point : curve.points) values.push_back(point.x);
        plot.curves.push_back(std::move(curve));
    }
    plot.x = axis_around(family.parameter, values, true, AxisUnit::power);
    plot.y = axis_around("largest error", errors, true, AxisUnit::power);
    plot.floor = 1e-4;
    plot.floor_label = "below the usual tolerance, 10⁻⁴";
    return plot;
}

}  // namespace

std::string stress_section(const StressResult& result) {
    if (result.families.empty()) return "";
    std::string html =
        "<section aria-labelledby=\"stability\">\n<h2 id=\"stability\">Numerical stability</h2>\n"
        "<p class=\"lead\">" +
        html_text(stress_verdict(result)) +
        "</p>\n<p>Stiff and extreme scenes against a reference in 113-bit arithmetic. A pixel is "
        "wrong when a channel is off by over 1/255 where the reference itself does not change "
        "within 0.02 pixel; the error is the largest there.</p>\n" +
        verdicts_table(result);
    std::string plots;
    for (const std::size_t i : by_margin(result)) {
        const StressFamilyResult& family = result.families[i];
        const bool is_plotted = std::find(plotted_families.begin(), plotted_families.end(),
                                          family.name) != plotted_families.end();
        if (!is_plotted || family.cases.size() < 2) continue;
        plots += plot_figure(family_plot(family, i), html_text(family.name + ": " + family.why));
    }
    if (!plots.empty()) {
        html += "<h3>Error against each family's parameter</h3>\n<div class=\"plots\">\n" + plots +
                "</div>\n";
    }
    return html + stress_pictures(result) + "</section>\n";
}

}  // namespace rt
