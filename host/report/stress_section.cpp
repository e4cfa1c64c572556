// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "host/print/stress_text.h"
#include "host/report/html.h"
#include "host/report/plots.h"
#include "host/report/sections.h"

namespace rt {

namespace {

/// Families whose parameter is a number that spans decades.
constexpr std::array<std::string_view, 16> plotted_families{
    "scale-2",   "shift-odd",       "sphere-size",    "cone-size",    "cone-needle", "flat-cone",
    "long-cone", "huge-ball-floor", "facing-mirrors", "glass-depth",  "light-pipe",  "shininess",
    "highlight", "field-of-view",   "needles",        "huge-triangle"};

constexpr double least_error = 1e-9;  ///< drawn; a picture's values are floats

std::string family_source(std::size_t family) { return fmt::format("stress#/families/{}", family); }

std::string figures_text(const PictureFigures& figures) {
    std::string text =
        fmt::format("{} wrong, {}", figures.wrong, scientific_text(figures.max_error));
    if (figures.nans > 0) text += fmt::format(", {} NaN", figures.nans);
    return text;
}

/// Seconds of tracing all cases in float: on threads, and by textbook formulas.
std::string time_text(const StressFamilyResult& family) {
    double ours = 0, naive = 0;
    for (const StressCaseResult& one : family.cases) {
        for (const StressRow& row : one.rows) {
            if (row.double_precision) continue;
            if (row.device == "threads") ours += row.seconds;
            if (row.renderer == "naive, + 1e-4 n") naive += row.seconds;
        }
    }
    if (naive == 0) return ours == 0 ? "" : duration_text(ours);
    return fmt::format("{}, {}", duration_text(ours), duration_text(naive));
}

bool has_naive_rows(const StressFamilyResult& family) {
    return std::any_of(family.cases.begin(), family.cases.end(), [](const StressCaseResult& one) {
        return !one.rows.empty() && one.rows.back().naive;
    });
}

std::string verdicts_table(const StressResult& result) {
    HtmlTable table{
        "Worst of every family's cases and renderers, float and double; time on threads "
        "in float, and that of textbook formulas",
        {"family", "verdict", "cases", "worst", "allowed", "textbook formulas", "traced in",
         "typical failure"},
        {}};
    for (std::size_t i = 0; i < result.families.size(); ++i) {
        const StressFamilyResult& family = result.families[i];
        const std::string naive =
            has_naive_rows(family) ? figures_text(worst_figures(family, true)) : "";
        table.rows.push_back({{family.name, family_source(i)},
                              {family.passed() ? "pass" : "fail", "", !family.passed()},
                              {std::to_string(family.cases.size()), ""},
                              {figures_text(worst_figures(family, false)), ""},
                              {bar_text(loosest_bar(family)), ""},
                              {naive, ""},
                              {time_text(family), ""},
                              {family.why, ""}});
    }
    return html_table(table);
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

/// Threads stand for all devices: in strict arithmetic their pictures are the same.
bool is_drawn(const StressRow& row) {
    return row.device == "threads" || row.renderer == "naive, t > 1e-3";
}

Plot family_plot(const StressFamilyResult& family, std::size_t index) {
    Plot plot;
    plot.id = "stress-" + family.name;
    plot.title = fmt::format("Largest error against the {}: {}", family.parameter, family.name);
    plot.description =
        "Both axes logarithmic; away from edges, values clamped to 0 to 1; NaN counts as 1.";
    std::vector<double> values, errors{least_error, 1.0};
    const std::vector<StressRow>& rows = family.cases.front().rows;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        if (!is_drawn(rows[row])) continue;
        PlotCurve curve = error_curve(family, index, row);
        curve.label = fmt::format("{}, {}", rows[row].naive ? "textbook" : "mirrorball",
                                  rows[row].double_precision ? "double" : "float");
        curve.color = rows[row].naive ? 1 : 0;
        curve.shape = rows[row].double_precision ? 1 : 0;
        for (const PlotPoint& point : curve.points) values.push_back(point.x);
        plot.curves.push_back(std::move(curve));
    }
    plot.x = axis_around(family.parameter, values, true, AxisUnit::power);
    plot.y = axis_around("largest error", errors, true, AxisUnit::power);
    plot.floor = 1e-4;
    plot.floor_label = "below the usual bar of 1e-4";
    return plot;
}

}  // namespace

std::string stress_section(const StressResult& result) {
    std::string html =
        "<section aria-labeledby=\"stress\">\n<h2 id=\"stress\">Numerical stability</h2>\n"
        "<p>Stiff and extreme scenes against a reference in 113-bit arithmetic. A pixel is wrong "
        "when a channel is off by over 1/255 where the reference itself does not change within "
        "0.02 pixel; the error is the largest there.</p>\n";
    html += verdicts_table(result);
    for (std::size_t i = 0; i < result.families.size(); ++i) {
        const StressFamilyResult& family = result.families[i];
        const bool is_plotted = std::find(plotted_families.begin(), plotted_families.end(),
                                          family.name) != plotted_families.end();
        if (!is_plotted || family.cases.size() < 2) continue;
        html += plot_figure(family_plot(family, i), html_text(family.name + ": " + family.why));
    }
    return html + stress_pictures(result) + "</section>\n";
}

}  // namespace rt
