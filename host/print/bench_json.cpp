// SPDX-License-Identifier: Apache-2.0
#include "host/base/text.h"
#include "host/measure/bench.h"
#include "host/print/print_bench.h"
#include "host/print/print_run.h"

namespace rt {

namespace {

using Json = nlohmann::ordered_json;

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

/// Null unless the row is right.
Json figures_json(const BenchResult& result, const BenchRow& row) {
    const auto figures = figures_of(result, row);
    if (!figures) return nullptr;
    return {{"trace", spread_json(figures->trace)},
            {"total", spread_json(figures->total)},
            {"rays_per_second", figures->rays_per_second},
            {"threads", figures->threads},
            {"speed_up", optional_json(figures->speed_up)},
            {"trace_speed_up", optional_json(figures->trace_speed_up)},
            {"parallel_fraction", optional_json(figures->parallel_fraction)},
            {"amdahl", optional_json(figures->amdahl)},
            {"over_amdahl", optional_json(figures->over_amdahl)}};
}

Json row_json(const BenchRow& row, Json figures) {
    const BenchCase& asked = row.asked;
    Json json{{"key", key_of(asked)},
              {"scene", scene_json(asked.scene_path, asked.scene_name, asked.scene_hash)},
              {"width", asked.width},
              {"height", asked.height},
              {"aa", to_string(asked.aa)},
              {"precision", precision_name(asked.double_precision)},
              {"device", asked.device},
              {"device_name", asked.device_name},
              {"threads", asked.threads},
              {"schedule", asked.schedule}};
    add_runs(json, row, std::move(figures));
    return json;
}

/// Null unless the row and the usual one are right.
Json ablation_figures_json(const BenchResult& result, const BenchRow& row) {
    const auto figures = ablation_figures(result, row);
    if (!figures) return nullptr;
    return {{"trace", spread_json(figures->trace)},
            {"first_build", figures->first_build},
            {"ratio", figures->ratio}};
}

Json ablation_json(const BenchResult& result, const BenchRow& row) {
    Json json = row_json(row, ablation_figures_json(result, row));
    json["change"] = row.asked.change;
    return json;
}

Json reference_json(const RenderStats& run) {
    Json json{{"scene", scene_json(run.scene.path, run.scene.name, run.scene.hash)}};
    json.update(run_json(run));
    return json;
}

}  // namespace

Json bench_json(const BenchResult& result) {
    Json references = Json::array(), rows = Json::array();
    for (const RenderStats& run : result.references) references.push_back(reference_json(run));
    for (const BenchRow& row : result.rows) {
        rows.push_back(row_json(row, figures_json(result, row)));
    }
    Json ablation = Json::array();
    for (const BenchRow& row : result.ablation) ablation.push_back(ablation_json(result, row));
    return {{"format", "mirrorball-bench"},
            {"version", 1},
            {"environment", bench_environment_json(result.load_before)},
            {"repeats", result.repeats_asked},
            {"interrupted", result.interrupted},
            {"references", references},
            {"rows", rows},
            {"ablation", ablation}};
}

}  // namespace rt
