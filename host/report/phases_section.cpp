// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <span>

#include "host/report/html.h"
#include "host/report/labels.h"
#include "host/report/plot_axis.h"
#include "host/report/plots.h"
#include "host/report/svg_bars.h"

namespace rt {

namespace {

struct Phase {
    const char* name;
    double (*seconds)(const RenderStats& run);
};

constexpr std::array<Phase, 8> phases{{
    {"load", [](const RenderStats& run) { return run.phases.load; }},
    {"flatten", [](const RenderStats& run) { return run.phases.flatten; }},
    {"open", [](const RenderStats& run) { return run.phases.renderer.open; }},
    {"build", [](const RenderStats& run) { return run.phases.renderer.build; }},
    {"upload", [](const RenderStats& run) { return run.phases.renderer.upload; }},
    {"trace", [](const RenderStats& run) { return run.phases.renderer.trace; }},
    {"resolve", [](const RenderStats& run) { return run.phases.renderer.resolve; }},
    {"read back", [](const RenderStats& run) { return run.phases.renderer.read_back; }},
}};

Bar phases_bar(const std::string& label, const std::string& source,
               std::span<const RenderStats> runs) {
    Bar bar{label, source, {}};
    for (std::size_t i = 0; i < phases.size(); ++i) {
        const double seconds = spread_of(runs, phases[i].seconds).median;
        bar.parts.push_back({phases[i].name, seconds, static_cast<int>(i)});
    }
    return bar;
}

/// The bars in words, for those who cannot see them.
std::string spoken(const std::vector<Bar>& bars) {
    std::string text;
    for (const Bar& bar : bars) {
        text += bar.label + ":";
        for (const BarPart& part : bar.parts) {
            if (part.seconds > 0)
                text += " " + part.label + " " + duration_text(part.seconds) + ",";
        }
        text.back() = '.';
        text += " ";
    }
    return text;
}

bool built_anew(const BenchRow& row) {
    return !row.warm_up.empty() &&
           row.warm_up.front().phases.renderer.build_cache == BuildCache::cold;
}

std::string cold_label(const BenchRow& row) {
    return fmt::format("{}, {} x {} pixels, {}, {}", device_label(row), row.asked.width,
                       row.asked.height, to_string(row.asked.aa),
                       row.asked.double_precision ? "double" : "float");
}

std::string bars_figure(BarChart chart, const std::string& caption) {
    chart.description = spoken(chart.bars);
    return figure_html(svg_bars(chart), chart.title, bars_legend(chart), html_text(caption));
}

}  // namespace

std::string phases_figure(const std::vector<PlacedRow>& rows, std::size_t index) {
    const std::vector<PlacedRow> largest = largest_rows(rows);
    if (largest.empty()) return "";
    BarChart warm{fmt::format("phases-{}", index), "Where the time goes, device by device", "", {}};
    for (const PlacedRow& placed : largest) {
        warm.bars.push_back(
            phases_bar(device_label(*placed.row), placed.source + "/repeats", placed.row->repeats));
    }
    BarChart cold{
        fmt::format("phases-cold-{}", index), "Where a first picture's time goes", "", {}};
    for (const PlacedRow& placed : rows) {
        if (!built_anew(*placed.row)) continue;
        cold.bars.push_back(
            phases_bar(cold_label(*placed.row), placed.source + "/warm_up", placed.row->warm_up));
    }
    const BenchCase& asked = largest.front().row->asked;
    std::string html =
        "<h3>Where the time goes</h3>\n" +
        bars_figure(warm, fmt::format("{} x {} pixels, {}, float: the median of "
                                      "each phase, kernels from a cache.",
                                      asked.width, asked.height, to_string(asked.aa)));
    if (!cold.bars.empty()) {
        html += bars_figure(cold,
                            "The first picture after an install: kernels are compiled once, "
                            "then kept.");
    }
    return html;
}

}  // namespace rt
