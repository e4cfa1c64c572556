// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "host/base/text.h"
#include "host/print/environment_json.h"
#include "host/print/flatten_text.h"
#include "host/print/print_image_error.h"
#include "host/print/print_stats.h"

namespace rt {

namespace {

using Json = nlohmann::ordered_json;

Json scene_json(const RenderStats& stats) {
    return {{"path", printable(stats.scene.path)},
            {"name", stats.scene.name},
            {"hash", hash_text(stats.scene.hash)},
            {"spheres", stats.scene.spheres},
            {"cones", stats.scene.cones},
            {"triangles", stats.scene.triangles},
            {"smooth_triangles", stats.scene.smooth_triangles},
            {"lights", stats.scene.lights},
            {"materials", stats.scene.materials},
            {"flat_bytes", stats.scene.bytes},
            {"hierarchies", hierarchies_json(stats.scene.flatten)},
            {"hierarchy_seconds", stats.scene.flatten.bvh_seconds},
            {"shadow_casters", stats.scene.flatten.casters},
            {"lit_triangles", stats.scene.flatten.lit_triangles},
            {"features_used", names_of(stats.features, true)},
            {"features_left_out", names_of(stats.features, false)}};
}

Json settings_json(const RenderStats& stats) {
    return {{"width", stats.width},
            {"height", stats.height},
            {"region", {stats.region.x, stats.region.y, stats.region.width, stats.region.height}},
            {"aa", to_string(stats.aa)},
            {"samples", stats.aa.samples()},
            {"filter", to_string(stats.filter)},
            {"max_bounces", stats.max_bounces},
            {"precision", precision_name(stats.double_precision)},
            {"math", math_name(stats.fast_math)},
            {"features", stats.all_features ? "all" : "auto"},
            {"features_added", names_of(stats.also_features, true)},
            {"hierarchies", !stats.hierarchies   ? "auto"
                            : *stats.hierarchies ? "on"
                                                 : "off"},
            {"caster_lists", stats.caster_lists ? "on" : "off"}};
}

Json device_json(const DeviceStats& device) {
    Json json{{"name", device.name}};
    if (!device.platform.empty()) {
        json["platform"] = device.platform;
        json["driver"] = device.driver;
        json["launch"] = device.launch;
    } else {
        json["threads"] = device.threads;
        json["schedule"] = device.schedule;
    }
    json["lanes"] = device.lanes;
    if (!device.isa.empty()) json["isa"] = device.isa;
    if (!device.fallback_from.empty()) json["fallback_from"] = device.fallback_from;
    return json;
}

Json shares_json(const std::vector<DeviceShare>& shares) {
    Json json = Json::array();
    for (const DeviceShare& share : shares) {
        Json one{{"name", share.name}, {"pixels", share.pixels}};
        one["ready"] = share.ready > 0 ? Json(share.ready) : Json(nullptr);
        if (!share.failure.empty()) one["failure"] = share.failure;
        json.push_back(std::move(one));
    }
    return json;
}

Json phases_json(const PhaseStats& phases) {
    const RendererTimes& renderer = phases.renderer;
    return {{"start", phases.start},
            {"load", phases.load},
            {"flatten", phases.flatten},
            {"open", renderer.open},
            {"build", renderer.build},
            {"upload", renderer.upload},
            {"self_test", renderer.check},
            {"trace", renderer.trace},
            {"kernel", renderer.kernel},
            {"resolve", renderer.resolve},
            {"read_back", renderer.read_back},
            {"write", phases.write},
            {"total", phases.total},
            {"set_up", phases.set_up()},
            {"resolve_and_write", phases.resolve_and_write()}};
}

}  // namespace

std::string json_text(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json stats_json(const RenderStats& stats) {
    Json json{{"format", "mirrorball-render"},
              {"version", 1},
              {"environment", environment_json()},
              {"scene", scene_json(stats)},
              {"settings", settings_json(stats)},
              {"device", device_json(stats.device)},
              {"seconds", phases_json(stats.phases)},
              {"rays",
               {{"primary", stats.rays.primary},
                {"shadow", stats.rays.shadow},
                {"mirror", stats.rays.mirror},
                {"transmitted", stats.rays.transmitted},
                {"total", stats.rays.total()}}},
              {"rays_per_second", stats.rays_per_second()},
              {"image", {{"hash", hash_text(stats.image_hash)}, {"non_finite", stats.non_finite}}},
              {"complete", stats.complete()}};
    if (stats.shares.size() > 1) json["devices"] = shares_json(stats.shares);
    if (stats.resumed > 0) json["resumed"] = stats.resumed;
    if (stats.tiles_checked > 0) json["tiles_checked"] = stats.tiles_checked;
    if (stats.error) json["error"] = error_json(*stats.error);
    return json;
}

}  // namespace rt
