// SPDX-License-Identifier: Apache-2.0
#include "host/report/verdict.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/base/text.h"
#include "host/measure/bench.h"
#include "host/report/labels.h"
#include "host/report/plot_axis.h"

namespace rt {

namespace {

/// "All 24 measured settings of device, size and sampling gave the right picture; ..."
std::string correctness_text(const BenchResult& bench) {
    std::size_t timed = 0, wrong = 0, failed = 0;
    double rounding = 0;
    for (const BenchRow& row : bench.rows) {
        wrong += row.verdict == Verdict::wrong ? 1 : 0;
        failed += row.verdict == Verdict::failed ? 1 : 0;
        if (!row.has_figures()) continue;
        ++timed;
        const auto& error = row.repeats.front().error;
        if (error && !row.asked.double_precision) rounding = std::max(rounding, error->rmse);
    }
    if (wrong + failed > 0) {
        return fmt::format("Of {}, {} gave a wrong picture and {} failed.",
                           counted(bench.rows.size(), "measured setting"), wrong, failed);
    }
    return fmt::format(
        "All {} measured settings of device, size and sampling gave the right picture; float is "
        "within RMSE {} of double.",
        timed, scientific_text(rounding));
}

/// "With set-up it takes 41 ms, one thread 330 ms."
std::string total_text(const BenchFigures& figures) {
    const double total = figures.total.median;
    const bool alone = !figures.speed_up || figures.threads == 1;
    return fmt::format("With set-up it takes {}{}.", duration_text(total),
                       alone ? "" : ", one thread " + duration_text(*figures.speed_up * total));
}

}  // namespace

const RenderStats& some_run(const ReportScene& scene) {
    return scene.has_pictures ? scene.plain.stats : scene.bench.references.back();
}

std::string scene_name(const ReportScene& scene) {
    const SceneStats& stats = some_run(scene).scene;
    return stats.name.empty() ? stats.path : stats.name;
}

std::optional<PlacedRow> fastest_row(const ReportScene& scene, std::size_t index) {
    const std::vector<PlacedRow> rows = largest_rows(rows_of(scene.bench, index));
    const auto fastest =
        std::min_element(rows.begin(), rows.end(), [](const PlacedRow& a, const PlacedRow& b) {
            return a.figures->trace.median < b.figures->trace.median;
        });
    return fastest == rows.end() ? std::nullopt : std::optional(*fastest);
}

std::string verdict_text(const ReportScene& scene, std::size_t index) {
    const auto fastest = fastest_row(scene, index);
    if (!fastest) return "";
    const BenchFigures& figures = *fastest->figures;
    std::string text = fmt::format("{} {} {} in {}", device_label(*fastest->row),
                                   figures.threads > 1 ? "trace" : "traces", scene_name(scene),
                                   duration_text(figures.trace.median));
    if (figures.trace_speed_up && figures.threads != 1) {
        text += fmt::format(": {} times as fast as one thread",
                            significant(*figures.trace_speed_up, 3));
    }
    return text;
}

std::string verdict_details(const ReportScene& scene, std::size_t index) {
    const auto fastest = fastest_row(scene, index);
    if (!fastest) return "";
    const BenchCase& asked = fastest->row->asked;
    return fmt::format("{} pixels, {}, float. {} {}", size_text(asked.width, asked.height),
                       sampling_text(asked.aa), total_text(*fastest->figures),
                       correctness_text(scene.bench));
}

}  // namespace rt
