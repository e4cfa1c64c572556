// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "host/base/text.h"
#include "host/report/html.h"
#include "host/report/labels.h"
#include "host/report/plot_axis.h"
#include "host/report/plots.h"
#include "host/report/rows.h"
#include "host/report/sections.h"

namespace rt {

namespace {

/// Cell text for a row without figures.
std::string verdict_text(const BenchRow& row) { return to_string(row.verdict); }

/// Rows with one sampling and precision, laid out like the paper's: sizes down, devices across.
HtmlTable paper_table(const std::vector<PlacedRow>& rows) {
    HtmlTable table;
    const BenchCase& first = rows.front().row->asked;
    const std::string sampling = sampling_text(first.aa);
    table.caption = fmt::format("Ray trace, {}, {}: milliseconds, medians; fastest in bold",
                                sampling, precision_name(first.double_precision));
    table.heads = {"pixels"};
    for (const PlacedRow& placed : rows) {
        const std::string label = device_label(*placed.row);
        const bool known =
            std::find(table.heads.begin(), table.heads.end(), label) != table.heads.end();
        if (!known) table.heads.push_back(label);
    }
    std::map<std::int64_t, std::vector<HtmlCell>> lines;
    std::map<std::int64_t, double> fastest;
    for (const PlacedRow& placed : rows) {
        if (!placed.figures) continue;
        double& best = fastest.emplace(pixels_of(placed.row->asked), 1e300).first->second;
        best = std::min(best, placed.figures->trace.median);
    }
    for (const PlacedRow& placed : rows) {
        const std::int64_t pixels = pixels_of(placed.row->asked);
        auto& cells = lines[pixels];
        cells.resize(table.heads.size());
        cells[0].text = size_text(placed.row->asked.width, placed.row->asked.height);
        const auto column =
            std::find(table.heads.begin(), table.heads.end(), device_label(*placed.row)) -
            table.heads.begin();
        HtmlCell& cell = cells[static_cast<std::size_t>(column)];
        cell.source = placed.source;
        cell.text =
            placed.figures ? milliseconds(placed.figures->trace.median) : verdict_text(*placed.row);
        cell.strong = placed.figures && placed.figures->trace.median == fastest[pixels];
    }
    for (auto& [pixels, cells] : lines) table.rows.push_back(std::move(cells));
    return table;
}

/// Single rays are in the plot and in the table of all settings; a buffer per sample is a schedule
/// of its own only where there are several samples and threads.
bool in_paper_tables(const BenchCase& asked) {
    if (asked.schedule == "buffers") return asked.threads > 1 && asked.aa.samples() > 1;
    return asked.schedule != "scalar";
}

std::string paper_tables(const std::vector<PlacedRow>& rows) {
    std::vector<std::vector<PlacedRow>> groups;
    for (const PlacedRow& placed : rows) {
        if (!in_paper_tables(placed.row->asked)) continue;
        const auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& others) {
            const BenchCase& other = others.front().row->asked;
            return other.aa == placed.row->asked.aa &&
                   other.double_precision == placed.row->asked.double_precision;
        });
        if (group == groups.end()) {
            groups.push_back({placed});
        } else {
            group->push_back(placed);
        }
    }
    std::string html;
    for (const auto& group : groups) html += html_table(paper_table(group));
    return html;
}

std::vector<HtmlCell> full_row(const PlacedRow& placed) {
    const BenchCase& asked = placed.row->asked;
    std::vector<HtmlCell> cells{{size_text(asked.width, asked.height), placed.source},
                                {to_string(asked.aa), ""},
                                {precision_name(asked.double_precision), ""},
                                {device_label(*placed.row), ""}};
    if (!placed.figures) {
        cells.push_back({fmt::format("{}: {}", verdict_text(*placed.row), placed.row->why), ""});
        cells.resize(11);
        return cells;
    }
    const BenchFigures& figures = *placed.figures;
    const auto optional = [](const std::optional<double>& value) {
        return HtmlCell{value ? significant(*value, 3) : "–", ""};
    };
    const auto& error = placed.row->repeats.front().error;
    cells.push_back({milliseconds(figures.trace.median), ""});
    cells.push_back({significant(figures.trace.noise_percent(), 2), ""});
    cells.push_back({milliseconds(figures.total.median), ""});
    cells.push_back({significant(figures.rays_per_second * 1e-6, 3), ""});
    cells.push_back(optional(figures.trace_speed_up));
    cells.push_back(optional(figures.speed_up));
    cells.push_back({error ? scientific_text(error->rmse) : "–", ""});
    return cells;
}

std::string full_table(const std::vector<PlacedRow>& rows) {
    HtmlTable table{
        "All settings; total excludes starting the program, reading the scene and writing the "
        "picture; speed-up is over one thread; RMSE is against double precision at the same "
        "samples",
        {"pixels", "sampling", "precision", "device", "trace, ms", "noise, %", "total, ms",
         "Mrays/s", "trace speed-up", "total speed-up", "RMSE"},
        {}};
    for (const PlacedRow& placed : rows) table.rows.push_back(full_row(placed));
    return fmt::format(
               "<p class=\"on-paper\">The table of all {} settings, with noise, rays per second, "
               "speed-up and error, is left out on paper.</p>\n<details><summary>All {} settings, "
               "with noise, rays per second, speed-up and error</summary>\n",
               rows.size(), rows.size()) +
           html_table(table) + "</details>\n";
}

}  // namespace

std::string timing_section(const ReportScene& scene, std::size_t index) {
    const std::vector<PlacedRow> rows = rows_of(scene.bench, index);
    if (rows.empty()) return "";
    const DeviceColors colors(scene.bench.rows);
    return fmt::format(
               "<h3>Time</h3>\n"
               "<p>Medians of {} repeats, interleaved so that a slow moment of the machine affects "
               "every row equally; the first round is not counted. A wrong picture gets no time. "
               "With sample buffers, the paper's schedule, each thread traces one sample of every "
               "pixel at a time.</p>\n",
               scene.bench.repeats_asked) +
           paper_tables(rows) + full_table(rows) + phases_figure(rows, colors) +
           size_figures(rows, index, colors) + threads_html(rows, index);
}

}  // namespace rt
