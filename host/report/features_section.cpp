// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "host/base/text.h"
#include "host/flatten/features.h"
#include "host/measure/statistics.h"
#include "host/print/flatten_text.h"
#include "host/print/print_stats.h"
#include "host/report/html.h"
#include "host/report/labels.h"
#include "host/report/plot_axis.h"
#include "host/report/sections.h"

namespace rt {

namespace {

double kernel_build_seconds(const RenderStats& run) { return run.phases.renderer.build; }

std::string build_text(const std::vector<RenderStats>& runs) {
    return duration_text(spread_of(runs, kernel_build_seconds).median);
}

std::string cold_text(const std::optional<RenderStats>& run) {
    return run ? duration_text(kernel_build_seconds(*run)) : "not measured";
}

/// The ratio of two medians with its noise: relative deviations add in quadrature.
std::string ratio_text(const Spread& lean, const Spread& full) {
    const double ratio = lean.median > 0 ? full.median / lean.median : 0;
    const double noise = ratio * std::hypot(lean.noise_percent(), full.noise_percent()) / 100;
    const bool is_told = std::fabs(ratio - 1) > noise;
    return fmt::format("Compiled with everything, tracing takes {} ± {} times as long{}.",
                       significant(ratio, 3), significant(noise, 2),
                       is_told ? "" : ": no difference beyond the noise");
}

std::string trial_html(const FeatureTrial& trial, const std::string& source) {
    const Spread lean = spread_of(trial.lean, trace_seconds);
    const Spread full = spread_of(trial.full, trace_seconds);
    const bool same = trial.lean.front().image_hash == trial.full.front().image_hash;
    HtmlTable table{fmt::format("On {}, {} pixels, {}: medians of {} interleaved repeats",
                                device_label(trial.lean.front()),
                                size_text(trial.lean.front().width, trial.lean.front().height),
                                to_string(trial.lean.front().aa), trial.lean.size()),
                    {"kernels compiled with", "build, from cache", "build, cold"},
                    {}};
    table.rows.push_back({{"what the scene needs", source + "/auto"},
                          {build_text(trial.lean), ""},
                          {cold_text(trial.lean_cold), ""}});
    table.rows.push_back({{"everything", source + "/all"},
                          {build_text(trial.full), ""},
                          {cold_text(trial.full_cold), ""}});
    return html_table(table) +
           fmt::format("<p{}>{} The pictures are {}.</p>\n", html_attribute("data-source", source),
                       html_text(ratio_text(lean, full)),
                       same ? "the same, bit for bit" : "<strong>not the same</strong>");
}

/// How much of a feature the scene has, if known.
std::string in_scene_text(const RenderStats& stats, bool Features::*flag) {
    const auto count = [](std::size_t n) { return n > 0 ? std::to_string(n) : "none"; };
    if (flag == &Features::spheres) return count(stats.scene.spheres);
    if (flag == &Features::cones) return count(stats.scene.cones);
    if (flag == &Features::triangles) return count(stats.scene.triangles);
    if (flag == &Features::vertex_normals) return count(stats.scene.smooth_triangles);
    if (flag == &Features::lights) return count(stats.scene.lights);
    if (!(stats.features.*flag)) return "none";
    if (flag == &Features::hierarchy) return hierarchies_text(stats.scene.flatten);
    if (flag == &Features::mirrors || flag == &Features::glass) {
        return fmt::format("up to {} bounces", stats.max_bounces);
    }
    return "";
}

}  // namespace

std::string features_section(const ReportScene& scene, std::size_t index) {
    const RenderStats& stats = scene.plain.stats;
    const std::string source = fmt::format("features-{}#", index);
    std::string html = "<h3>What the scene needs, and what was left out</h3>\n";
    HtmlTable table{"Features of the kernels", {"feature", "compiled", "in the scene"}, {}};
    for (const FeatureName& feature : feature_names) {
        table.rows.push_back({{feature.name, ""},
                              {stats.features.*feature.flag ? "used" : "left out", ""},
                              {in_scene_text(stats, feature.flag), ""}});
    }
    html += html_table(table);
    html += fmt::format(
        "<p>The flattened scene is {} bytes in {}. A feature left out is not "
        "compiled, and its array is not allocated: it is a null argument of the "
        "kernel.</p>\n",
        stats.scene.bytes, precision_name(stats.double_precision));
    if (names_of(stats.features, false).empty()) {
        html +=
            "<p>This scene needs everything, so there is nothing to leave out: both rows below use "
            "the same kernels, and their difference is noise.</p>\n";
    } else {
        html += "<p>Left out: " + html_text(names_text(stats.features, false)) + ".</p>\n";
    }
    if (!scene.trial && !scene.complete) return html;
    if (!scene.trial) return html + "<p>Without an OpenCL device nothing is compiled.</p>\n";
    return html + trial_html(*scene.trial, source);
}

}  // namespace rt
