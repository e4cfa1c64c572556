// SPDX-License-Identifier: Apache-2.0
#include "host/report/report_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/measure/converge.h"
#include "host/measure/machine_load.h"
#include "host/print/run_json.h"
#include "host/print/stats_json.h"
#include "host/print/stats_text.h"
#include "host/print/stress_json.h"
#include "host/report/html.h"
#include "host/report/labels.h"
#include "host/report/plot_axis.h"
#include "host/report/rows.h"
#include "host/report/sections.h"
#include "host/report/style.h"

namespace rt {

namespace {

using Json = nlohmann::ordered_json;

/// Any run of the scene, for what it says of the scene.
const RenderStats& some_run(const ReportScene& scene) {
    return scene.has_pictures ? scene.plain.stats : scene.bench.references.back();
}

std::string scene_name(const ReportScene& scene) {
    const SceneStats& stats = some_run(scene).scene;
    return stats.name.empty() ? stats.path : stats.name;
}

std::string head(const Report& report) {
    std::string names;
    for (const ReportScene& scene : report.scenes) {
        names += (names.empty() ? "" : ", ") + scene_name(scene);
    }
    return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
           "<meta name=\"color-scheme\" content=\"light dark\">\n"
           "<link rel=\"icon\" href=\"data:,\">\n<title>mirrorball report: " +
           html_text(names) + (report.stopped.empty() ? "" : " (incomplete)") +
           "</title>\n<style>" + report_style + "</style>\n</head>\n";
}

std::string tile(const std::string& term, const std::string& value, const std::string& more,
                 const std::string& source) {
    return fmt::format("<div><dt>{}</dt><dd{}>{}<small>{}</small></dd></div>\n", html_text(term),
                       source.empty() ? "" : html_attribute("data-source", source),
                       html_text(value), html_text(more));
}

/// The few numbers to take away: the fastest device, its rays, its gain, and how exact it is.
std::string glance(const Report& report, std::size_t index) {
    const ReportScene& scene = report.scenes[index];
    const std::vector<PlacedRow> rows = largest_rows(rows_of(scene.bench, index));
    const auto fastest =
        std::min_element(rows.begin(), rows.end(), [](const PlacedRow& a, const PlacedRow& b) {
            return a.figures->trace.median < b.figures->trace.median;
        });
    if (fastest == rows.end()) return "";
    const BenchFigures& figures = *fastest->figures;
    const BenchCase& asked = fastest->row->asked;
    const std::string on = "on " + device_label(*fastest->row);
    std::string html = "<dl class=\"glance\">\n";
    html +=
        tile("Fastest anti-aliased trace", duration_text(figures.trace.median),
             fmt::format("± {} %, {}, {} x {}, {}", significant(figures.trace.noise_percent(), 2),
                         on, asked.width, asked.height, to_string(asked.aa)),
             fastest->source);
    html += tile("Rays per second", significant(figures.rays_per_second * 1e-6, 3) + " million",
                 on + ", all kinds of ray", fastest->source);
    if (figures.speed_up) {
        html += tile("Speed-up over one thread", significant(*figures.speed_up, 3) + " times",
                     "total time, " + on, fastest->source);
    }
    const auto& rounding = fastest->row->repeats.front().error;
    if (rounding) {
        html += tile("Rounding error", "RMSE " + scientific_text(rounding->rmse),
                     "float against double, same samples", fastest->source);
    }
    html += tile("Sampling error", "RMSE " + scientific_text(scene.smooth.stats.error->rmse),
                 fmt::format("{}; plain: {}", to_string(scene.smooth.stats.aa),
                             scientific_text(scene.plain.stats.error->rmse)),
                 fmt::format("pictures-{}#/smooth/error", index));
    return html + "</dl>\n";
}

std::string scene_html(const Report& report, std::size_t index) {
    const ReportScene& scene = report.scenes[index];
    const RenderStats& run = some_run(scene);
    const SceneStats& stats = run.scene;
    std::string html = fmt::format(
        "<section id=\"scene-{}\" aria-labeledby=\"scene-{}-head\">\n"
        "<h2 id=\"scene-{}-head\">{}</h2>\n"
        "<p class=\"note\">{}: {}; {} x {} pixels, up to {} bounces; scene hash "
        "<code>{}</code></p>\n",
        index, index, index, html_text(scene_name(scene)), html_text(stats.path),
        holdings_text(run), run.width, run.height, run.max_bounces, hash_text(stats.hash));
    if (!scene.complete) html += "<p class=\"warning\">Incomplete: stopped on the way.</p>\n";
    if (scene.has_pictures) html += glance(report, index) + pictures_section(scene, index);
    html += timing_section(scene, index);
    if (!front_of(scene.converge).empty()) html += error_time_section(scene, index);
    if (scene.has_pictures) html += features_section(scene, index);
    return html + "</section>\n";
}

/// What a reader must know before any number.
std::string warnings_html(const Report& report) {
    std::string html;
    if (!report.stopped.empty()) {
        html += "<p class=\"warning\">Incomplete: " + html_text(report.stopped) +
                " before all was measured.</p>\n";
    }
    const std::string busy = busy_text(load_of(report.load_before));
    if (!busy.empty()) html += "<p class=\"warning\">" + html_text(busy) + "</p>\n";
    return html;
}

std::string text_of(const Json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string environment_html(const Report& report) {
    HtmlTable table{"The machine and the program behind every number", {"what", "value"}, {}};
    for (const auto& [key, value] : report.environment.items()) {
        table.rows.push_back({{key, ""}, {text_of(value), "environment#/" + key}});
    }
    std::vector<std::string> devices;
    for (const BenchRow& row : report.scenes.front().bench.rows) {
        if (row.repeats.empty() || row.asked.uses_threads) continue;
        const DeviceStats& device = row.repeats.front().device;
        const std::string text =
            fmt::format("{}, {}, driver {}, per {}, {} lane{}", device.name, device.platform,
                        device.driver, device.launch, device.lanes, device.lanes == 1 ? "" : "s");
        if (std::find(devices.begin(), devices.end(), text) != devices.end()) continue;
        devices.push_back(text);
        table.rows.push_back({{"OpenCL device", ""}, {text, ""}});
    }
    table.rows.push_back({{"made on", ""}, {report.date, ""}});
    return "<h2 id=\"machine\">Environment</h2>\n<div class=\"facts\">" + html_table(table) +
           "</div>\n";
}

std::string commands_html(const Report& report) {
    std::string text;
    for (const std::string& command : report.commands) text += command + "\n";
    return "<h2 id=\"commands\">Reproduce</h2>\n<p>The first line makes this page; the others "
           "make its parts.</p>\n<pre tabindex=\"0\"><code>" +
           html_text(text) + "</code></pre>\n";
}

std::string navigation(const Report& report) {
    std::string html = "<nav aria-label=\"Sections\"><ul>\n";
    for (std::size_t i = 0; i < report.scenes.size(); ++i) {
        html += fmt::format("<li><a href=\"#scene-{}\">{}</a></li>\n", i,
                            html_text(scene_name(report.scenes[i])));
    }
    if (report.stress) html += "<li><a href=\"#stress\">Numerical stability</a></li>\n";
    return html +
           "<li><a href=\"#machine\">Environment</a></li>\n"
           "<li><a href=\"#commands\">Reproduce</a></li>\n"
           "<li><a href=\"#data\">Raw data</a></li>\n</ul></nav>\n";
}

Json trial_json(const FeatureTrial& trial) {
    Json json{{"auto", runs_json(trial.lean)}, {"all", runs_json(trial.full)}};
    if (trial.lean_cold) json["auto_cold"] = stats_json(*trial.lean_cold);
    if (trial.full_cold) json["all_cold"] = stats_json(*trial.full_cold);
    return json;
}

std::string data_html(const Report& report) {
    std::string html =
        "<h2 id=\"data\">Raw data</h2>\n<p>Every number above comes from the repeats kept in this "
        "page as JSON, in <code>script</code> elements of type <code>application/json</code>. An "
        "element's <code>data-source</code> says which: <code>bench-0#/rows/3</code> is row 3 "
        "of the block <code>bench-0</code>.</p>\n" +
        json_block("environment", report.environment);
    for (std::size_t i = 0; i < report.scenes.size(); ++i) {
        const ReportScene& scene = report.scenes[i];
        if (scene.has_pictures) {
            html += json_block(fmt::format("pictures-{}", i),
                               {{"plain", stats_json(scene.plain.stats)},
                                {"smooth", stats_json(scene.smooth.stats)}});
        }
        html += json_block(fmt::format("bench-{}", i), scene.bench_json);
        html += json_block(fmt::format("converge-{}", i), scene.converge_json);
        if (scene.trial)
            html += json_block(fmt::format("features-{}", i), trial_json(*scene.trial));
    }
    if (report.stress) html += json_block("stress", stress_json(*report.stress));
    return html;
}

}  // namespace

std::string report_page(const Report& report) {
    std::string html = head(report) +
                       "<body>\n<header>\n<h1>How it renders, how fast, how exactly</h1>\n"
                       "<p class=\"lead\">A mirrorball report: pictures, run times and errors, "
                       "measured on one machine in one go.</p>\n" +
                       warnings_html(report) + navigation(report) + "</header>\n<main>\n";
    for (std::size_t i = 0; i < report.scenes.size(); ++i) html += scene_html(report, i);
    if (report.stress) html += stress_section(*report.stress);
    return html + environment_html(report) + commands_html(report) + data_html(report) +
           "</main>\n<footer>Made by " + html_text(text_of(report.environment["program"])) + ", " +
           html_text(report.date) +
           ". Nothing in this page comes from elsewhere, and no script "
           "runs.</footer>\n</body>\n</html>\n";
}

}  // namespace rt
