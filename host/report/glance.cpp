// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "host/report/html.h"
#include "host/report/labels.h"
#include "host/report/plot_axis.h"
#include "host/report/sections.h"
#include "host/report/verdict.h"

namespace rt {

namespace {

std::string tile(const std::string& term, const std::string& value, const std::string& more,
                 const std::string& source) {
    return fmt::format("<div><dt>{}</dt><dd{}>{}<small>{}</small></dd></div>\n", html_text(term),
                       source.empty() ? "" : html_attribute("data-source", source),
                       html_text(value), html_text(more));
}

}  // namespace

std::string glance_html(const ReportScene& scene, std::size_t index) {
    const auto fastest = fastest_row(scene, index);
    if (!fastest) return "";
    const BenchFigures& figures = *fastest->figures;
    const BenchCase& asked = fastest->row->asked;
    const std::string on = "on " + device_label(*fastest->row);
    std::string html = "<dl class=\"glance\">\n";
    html +=
        tile("Fastest ray trace", duration_text(figures.trace.median),
             fmt::format("± {}\u00a0%, {}, {}, {}", significant(figures.trace.noise_percent(), 2),
                         on, size_text(asked.width, asked.height), to_string(asked.aa)),
             fastest->source);
    html += tile("Rays per second", significant(figures.rays_per_second * 1e-6, 3) + "\u00a0M",
                 on + ", all kinds of ray", fastest->source);
    if (figures.speed_up && figures.trace_speed_up) {
        html += tile("Speed-up over one thread", significant(*figures.trace_speed_up, 3) + " times",
                     fmt::format("tracing, {}; {} times in total, with set-up", on,
                                 significant(*figures.speed_up, 3)),
                     fastest->source);
    }
    const auto& rounding = fastest->row->repeats.front().error;
    if (rounding) {
        html += tile("Rounding error (RMSE)", scientific_text(rounding->rmse),
                     "float against double, same samples", fastest->source);
    }
    html += tile("Sampling error (RMSE)", scientific_text(scene.smooth.stats.error->rmse),
                 fmt::format("{}; plain: {}", to_string(scene.smooth.stats.aa),
                             scientific_text(scene.plain.stats.error->rmse)),
                 fmt::format("pictures-{}#/smooth/error", index));
    return html + "</dl>\n";
}

}  // namespace rt
