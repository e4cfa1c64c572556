// SPDX-License-Identifier: Apache-2.0
#include "host/print/flatten_text.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

namespace rt {

namespace {

std::array<std::pair<const char*, const BvhShape*>, 3> by_kind(const FlattenStats& stats) {
    return {
        {{"spheres", &stats.spheres}, {"cones", &stats.cones}, {"triangles", &stats.triangles}}};
}

}  // namespace

std::string hierarchies_text(const FlattenStats& stats) {
    std::string text;
    for (const auto& [kind, shape] : by_kind(stats)) {
        if (shape->nodes == 0) continue;
        text += fmt::format("{}{} ({} nodes, {} deep)", text.empty() ? "" : ", ", kind,
                            shape->nodes, shape->depth);
    }
    if (text.empty()) return "no hierarchy: too few primitives";
    return fmt::format("hierarchy over {}, built in {:.3f} s", text, stats.bvh_seconds);
}

std::string casters_text(const FlattenStats& stats) {
    return fmt::format("{} of {} light-triangle pairs", stats.casters, stats.lit_triangles);
}

nlohmann::ordered_json hierarchies_json(const FlattenStats& stats) {
    auto json = nlohmann::ordered_json::array();
    for (const auto& [kind, shape] : by_kind(stats)) {
        if (shape->nodes == 0) continue;
        json.push_back({{"over", kind},
                        {"nodes", shape->nodes},
                        {"leaves", shape->leaves},
                        {"depth", shape->depth},
                        {"sah_cost", shape->sah_cost}});
    }
    return json;
}

}  // namespace rt
