// SPDX-License-Identifier: Apache-2.0
#include "host/report/report_page.h"

#include <fmt/format.h>

#include "host/base/text.h"
#include "host/measure/converge.h"
#include "host/measure/machine_load.h"
#include "host/print/print_run.h"
#include "host/print/print_stats.h"
#include "host/print/print_stress.h"
#include "host/report/html.h"
#include "host/report/labels.h"
#include "host/report/sections.h"
#include "host/report/style.h"
#include "host/report/verdict.h"

namespace rt {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* policy =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; base-uri 'none'; "
    "form-action 'none'";

std::string text_of(const Json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
}

/// "PoCL traces Cornell box in 22 ms: 14.7 times as fast as one thread", else the scenes' names.
std::string headline(const Report& report) {
    if (report.scenes.size() == 1) {
        const std::string verdict = verdict_text(report.scenes.front(), 0);
        if (!verdict.empty()) return verdict;
    }
    std::string names;
    for (const ReportScene& scene : report.scenes) {
        names += (names.empty() ? "" : ", ") + scene_name(scene);
    }
    return "How fast and how accurately mirrorball renders " + names;
}

/// "AMD EPYC 7763, 2 cores, 2026-11-20 12:00 UTC"
std::string machine_and_date(const Report& report) {
    const Json& machine = report.environment;
    std::string text;
    if (machine.contains("cpu")) text += text_of(machine["cpu"]) + ", ";
    if (machine.contains("cores")) {
        text += counted(machine["cores"].get<std::size_t>(), "core") + ", ";
    }
    return text + report.date;
}

std::string head(const Report& report) {
    return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta http-equiv=\"Content-Security-Policy\"" +
           html_attribute("content", policy) +
           ">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
           "<meta name=\"color-scheme\" content=\"light dark\">\n"
           "<link rel=\"icon\" href=\"data:,\">\n<title>" +
           html_text(headline(report) + " – mirrorball on " + machine_and_date(report)) +
           (report.stopped.empty() ? "" : " (incomplete)") + "</title>\n<style>" + report_style +
           "</style>\n</head>\n";
}

std::string lead_html(const std::string& text) {
    return text.empty() ? "" : "<p class=\"lead\">" + html_text(text) + "</p>\n";
}

/// The scene's verdict, if the page has several scenes.
std::string scene_verdict(const Report& report, std::size_t index) {
    const std::string verdict = verdict_text(report.scenes[index], index);
    if (report.scenes.size() == 1 || verdict.empty()) return "";
    return lead_html(verdict + ". " + verdict_details(report.scenes[index], index));
}

std::string scene_html(const Report& report, std::size_t index) {
    const ReportScene& scene = report.scenes[index];
    const RenderStats& run = some_run(scene);
    const SceneStats& stats = run.scene;
    std::string html = fmt::format(
        "<section id=\"scene-{}\" aria-labelledby=\"scene-{}-head\">\n"
        "<h2 id=\"scene-{}-head\">{}</h2>\n"
        "<p class=\"note\">{}: {}; {} pixels, up to {} bounces; scene hash "
        "<code>{}</code></p>\n",
        index, index, index, html_text(scene_name(scene)), html_text(stats.path),
        holdings_text(run), size_text(run.width, run.height), run.max_bounces,
        hash_text(stats.hash));
    html += scene_verdict(report, index);
    if (!scene.complete) html += "<p class=\"warning\">Incomplete: stopped before the end.</p>\n";
    if (scene.has_pictures) html += glance_html(scene, index) + pictures_section(scene, index);
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
                " before everything was measured.</p>\n";
    }
    std::string busy = busy_text(load_of(report.load_before));
    if (!busy.empty()) busy[0] = static_cast<char>(std::toupper(busy[0]));
    if (!busy.empty()) html += "<p class=\"warning\">" + html_text(busy) + "</p>\n";
    return html;
}

std::string commands_html(const Report& report) {
    std::string text;
    for (const std::string& command : report.commands) text += command + "\n";
    return "<h2 id=\"commands\">Reproduce</h2>\n"
           "<p>The first command makes this page; the others make parts of it.</p>\n"
           "<pre tabindex=\"0\"><code>" +
           html_text(text) + "</code></pre>\n";
}

std::string navigation(const Report& report) {
    std::string html = "<nav aria-label=\"Sections\"><ul>\n";
    for (std::size_t i = 0; i < report.scenes.size(); ++i) {
        html += fmt::format("<li><a href=\"#scene-{}\">{}</a></li>\n", i,
                            html_text(scene_name(report.scenes[i])));
    }
    if (report.stress) html += "<li><a href=\"#stability\">Numerical stability</a></li>\n";
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
    std::string html =
        head(report) + "<body>\n<header>\n<h1>" + html_text(headline(report)) + "</h1>\n";
    if (report.scenes.size() == 1) html += lead_html(verdict_details(report.scenes.front(), 0));
    html += "<p class=\"note\">A mirrorball report, measured in one run on " +
            html_text(machine_and_date(report)) + ".</p>\n" + warnings_html(report) +
            navigation(report) + "</header>\n<main>\n";
    for (std::size_t i = 0; i < report.scenes.size(); ++i) html += scene_html(report, i);
    if (report.stress) html += stress_section(*report.stress);
    return html + environment_section(report) + commands_html(report) + data_html(report) +
           "</main>\n<footer>Made by " + html_text(text_of(report.environment["program"])) + ", " +
           html_text(report.date) +
           ". This page loads nothing from elsewhere and runs no scripts.</footer>\n"
           "</body>\n"
           "</html>\n";
}

}  // namespace rt
