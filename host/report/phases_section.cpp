// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <span>

#include "host/base/text.h"
#include "host/report/bars.h"
#include "host/report/device_colors.h"
#include "host/report/html.h"
#include "host/report/labels.h"
#include "host/report/plots.h"

namespace rt {

namespace {

struct Phase {
    const char* name;
    double (*seconds)(const RenderStats& run);
};

constexpr std::array<Phase, 7> phases{{
    {"flatten", [](const RenderStats& run) { return run.phases.flatten; }},
    {"open", [](const RenderStats& run) { return run.phases.renderer.open; }},
    {"build", [](const RenderStats& run) { return run.phases.renderer.build; }},
    {"upload", [](const RenderStats& run) { return run.phases.renderer.upload; }},
    {"trace", [](const RenderStats& run) { return run.phases.renderer.trace; }},
    {"resolve", [](const RenderStats& run) { return run.phases.renderer.resolve; }},
    {"read back", [](const RenderStats& run) { return run.phases.renderer.read_back; }},
}};

Bar phases_bar(const std::string& label, const std::string& source, int color,
               std::span<const RenderStats> runs) {
    Bar bar{label, source, color, spread_of(runs, timed_total).median, {}};
    for (std::size_t i = 0; i < phases.size(); ++i) {
        const double seconds = spread_of(runs, phases[i].seconds).median;
        bar.parts.push_back({phases[i].name, seconds, static_cast<int>(i) + 1});
    }
    return bar;
}

bool built_cold(const BenchRow& row) {
    return !row.warm_up.empty() &&
           row.warm_up.front().phases.renderer.build > 0;
}

std::string cold_label(const BenchRow& row) {
    return fmt::format("{}, {} pixels, {}, {}", device_label(row),
                       size_text(row.asked.width, row.asked.height), to_string(row.asked.aa),
                       precision_name(row.asked.double_precision));
}

std::string bars_figure(const std::string& title, const std::vector<Bar>& bars,
                        const std::string& caption) {
    return "<figure class=\"plot\">" + bars_html(title, bars) + "<figcaption>" +
           html_text(caption) + "</figcaption></figure>\n";
}

}  // namespace

std::string phases_figure(const std::vector<PlacedRow>& rows, const DeviceColors& colors) {
    const std::vector<PlacedRow> largest = largest_rows(rows);
    if (largest.empty()) return "";
    std::vector<Bar> warm, cold;
    for (const PlacedRow& placed : largest) {
        warm.push_back(phases_bar(device_label(*placed.row), placed.source + "/repeats",
                                  colors.of(placed.row->asked), placed.row->repeats));
    }
    for (const PlacedRow& placed : rows) {
        if (!built_cold(*placed.row)) continue;
        cold.push_back(phases_bar(cold_label(*placed.row), placed.source + "/warm_up",
                                  colors.of(placed.row->asked), placed.row->warm_up));
    }
    const BenchCase& asked = largest.front().row->asked;
    std::string html =
        "<h3>Where the time goes</h3>\n" +
        bars_figure("Time by phase and device", warm,
                    fmt::format("{} pixels, {}, float; kernels from a cache. "
                                "Medians of the total and of each phase, so the "
                                "phases do not quite add up.",
                                size_text(asked.width, asked.height), sampling_text(asked.aa)));
    if (!cold.empty()) {
        html += "<h4>The first picture</h4>\n" +
                bars_figure("Time of a first picture by phase", cold,
                            "After installation, kernels are compiled once, then cached.");
    }
    return html;
}

}  // namespace rt
