// SPDX-License-Identifier: Apache-2.0
#include "host/base/text.h"
#include "host/measure/converge.h"
#include "host/print/print_converge.h"
#include "host/print/print_run.h"

namespace rt {

namespace {

using Json = nlohmann::ordered_json;

Json reference_json(const ConvergeReference& reference) {
    return {{"halves", {reference.aa_a, reference.aa_b}},
            {"hashes", {hash_text(reference.hash_a), hash_text(reference.hash_b)}},
            {"precision", "double"},
            {"max_bounces", reference.max_bounces},
            {"halves_rmse", reference.halves_rmse},
            {"floor", reference.floor()},
            {"from_cache", reference.from_cache},
            {"cache_path", reference.cache_path},
            {"seconds", reference.seconds}};
}

/// What distinguishes a point's build from others.
Json build_json(const ConvergeCase& of) {
    return {{"device", of.device},
            {"device_name", of.device_name},
            {"precision", precision_name(of.double_precision)},
            {"math", math_name(of.fast_math)}};
}

/// Null unless the point is right.
Json figures_json(const ConvergeResult& result, const ConvergePoint& point) {
    const auto figures = figures_of(result, point);
    if (!figures) return nullptr;
    return {{"seconds", spread_json(figures->seconds)},
            {"rmse", figures->rmse},
            {"below_floor", figures->below_floor}};
}

Json point_json(const ConvergeResult& result, const ConvergePoint& point) {
    Json json = build_json(point.asked);
    json["max_bounces"] = point.asked.max_bounces;
    json["aa"] = to_string(point.asked.aa);
    add_runs(json, point, figures_json(result, point));
    return json;
}

Json curves_json(const ConvergeResult& result) {
    Json list = Json::array();
    for (const Curve& curve : curves_of(result)) {
        Json json = build_json(curve.of);
        json["max_bounces"] = curve.of.max_bounces;
        json["family"] = curve.family;
        json["points"] = curve.points;
        json["slope"] = curve.slope ? Json(*curve.slope) : Json(nullptr);
        list.push_back(json);
    }
    return list;
}

Json builds_json(const ConvergeResult& result) {
    Json list = Json::array();
    for (const BuildOffset& offset : build_offsets(result)) {
        Json json = build_json(offset.of);
        json["open"] = offset.open;
        json["first_build"] = offset.first_build;
        json["warm_build"] = spread_json(offset.warm_build);
        list.push_back(json);
    }
    return list;
}

Json targets_json(const ConvergeResult& result) {
    Json list = Json::array();
    for (const TargetTime& time : target_times(result)) {
        list.push_back({{"device", time.device},
                        {"device_name", time.device_name},
                        {"rmse", time.target},
                        {"seconds", time.point ? Json(time.seconds) : Json()},
                        {"point", time.point ? Json(*time.point) : Json()},
                        {"below_floor", time.below_floor}});
    }
    return list;
}

}  // namespace

Json converge_json(const ConvergeResult& result) {
    Json points = Json::array();
    for (const ConvergePoint& point : result.points) points.push_back(point_json(result, point));
    return {{"format", "mirrorball-converge"},
            {"version", 1},
            {"environment", bench_environment_json(result.load_before)},
            {"scene", scene_json(result.scene_path, result.scene_name, result.scene_hash)},
            {"width", result.width},
            {"height", result.height},
            {"repeats", result.repeats_asked},
            {"interrupted", result.interrupted},
            {"reference", reference_json(result.reference)},
            {"points", points},
            {"pareto_front", front_of(result)},
            {"curves", curves_json(result)},
            {"builds", builds_json(result)},
            {"seconds_to_rmse", targets_json(result)}};
}

}  // namespace rt
