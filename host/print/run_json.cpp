// SPDX-License-Identifier: Apache-2.0
#include "host/base/text.h"
#include "host/measure/machine_load.h"
#include "host/print/environment_json.h"
#include "host/print/print_run.h"
#include "host/print/print_stats.h"

namespace rt {

using Json = nlohmann::ordered_json;

std::string json_start(const std::string& format) { return "{\n  \"format\": \"" + format + "\""; }

Json run_json(const RenderStats& run) {
    const Json whole = stats_json(run);
    Json json;
    if (run.started) json["started"] = *run.started;
    for (const char* key :
         {"settings", "device", "seconds", "rays", "rays_per_second", "image", "error"}) {
        if (whole.contains(key)) json[key] = whole[key];
    }
    return json;
}

Json runs_json(std::span<const RenderStats> runs) {
    Json json = Json::array();
    for (const RenderStats& run : runs) json.push_back(run_json(run));
    return json;
}

void add_runs(Json& json, const TimedRuns& runs, Json figures) {
    json["verdict"] = to_string(runs.verdict);
    json["why"] = runs.why;
    json["figures"] = std::move(figures);
    json["warm_up"] = runs_json(runs.warm_up);
    json["repeats"] = runs_json(runs.repeats);
}

Json scene_json(const std::string& path, const std::string& name, std::uint64_t hash) {
    return {{"path", printable(path)}, {"name", name}, {"hash", hash_text(hash)}};
}

Json spread_json(const Spread& spread) {
    return {
        {"median", spread.median}, {"mad", spread.mad}, {"min", spread.min}, {"max", spread.max}};
}

Json bench_environment_json(double load_before) {
    Json json = environment_json();
    json.update(machine_load_json(load_of(load_before)));
    return json;
}

}  // namespace rt
