// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "host/flatten/flat_scene.h"
#include "host/report/render_stats.h"
#include "host/scene/json_file.h"
#include "host/scene/scene_hash.h"
#include "host/verbs/verbs.h"

namespace rt {

namespace {

using Json = nlohmann::ordered_json;

Json info_json(const std::string& path, const Scene& scene, const FlatScene<float>& flat) {
    return {{"format", "mirrorball-scene-info"},
            {"version", 1},
            {"path", path},
            {"name", scene.name},
            {"hash", hash_text(scene_hash(scene))},
            {"width", scene.width},
            {"height", scene.height},
            {"aa", to_string(scene.aa)},
            {"max_bounces", scene.max_bounces},
            {"spheres", scene.spheres.size()},
            {"triangles", scene.triangles.size()},
            {"smooth_triangles", flat.vertex_normals.size()},
            {"lights", scene.lights.size()},
            {"lights_used", flat.lights.size()},
            {"materials", scene.materials.size()},
            {"flat_bytes", flat.bytes()},
            {"features_used", names_of(flat.features, true)},
            {"features_left_out", names_of(flat.features, false)}};
}

void print_info(const Scene& scene, const FlatScene<float>& flat) {
    fmt::print("{}\n", scene.name);
    fmt::print("  hash       {}\n", hash_text(scene_hash(scene)));
    fmt::print("  picture    {}x{} pixels, {}, up to {} mirror bounces\n", scene.width,
               scene.height, to_string(scene.aa), scene.max_bounces);
    fmt::print("  holds      {} spheres, {} triangles ({} smooth), {} materials, {} lights\n",
               scene.spheres.size(), scene.triangles.size(), flat.vertex_normals.size(),
               scene.materials.size(), scene.lights.size());
    fmt::print("  on device  {} bytes in float\n", flat.bytes());
    for (const FeatureName& feature : feature_names) {
        fmt::print("  {:<10} {}\n", flat.features.*feature.flag ? "needs" : "leaves out",
                   feature.name);
    }
    if (flat.lights.size() < scene.lights.size()) {
        fmt::print("  leaves out {} lights that shine on nothing\n",
                   scene.lights.size() - flat.lights.size());
    }
}

}  // namespace

int run_scene(const SceneOptions& options) {
    const Scene scene = load_json_scene(options.scene);
    const FlatScene<float> flat = flatten<float>(scene);
    if (options.json) {
        fmt::print("{}\n", info_json(options.scene, scene, flat).dump(2));
    } else if (options.info) {
        print_info(scene, flat);
    } else {
        fmt::print("{}: fine\n", options.scene);
    }
    return 0;
}

}  // namespace rt
