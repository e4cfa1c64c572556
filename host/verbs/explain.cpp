// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/text.h"
#include "host/measure/ray_tree.h"
#include "host/picture/render_stats.h"
#include "host/print/print_stats.h"
#include "host/print/ray_tree_text.h"
#include "host/scene/scene_file.h"
#include "host/scene/scene_hash.h"
#include "host/verbs/verbs.h"

namespace rt {

namespace {

Scene scene_to_explain(const ExplainOptions& options) {
    Scene scene = load_scene(options.scene, options.light);
    apply_overrides(scene, options.settings);
    if (scene.max_bounces > ExplainOptions::most_bounces) {
        throw Error(
            ExitCode::limit,
            fmt::format("{}: {} bounces are too many to explain; use --max-bounces {} or less",
                        printable(options.scene), scene.max_bounces, ExplainOptions::most_bounces));
    }
    if (options.x >= scene.width || options.y >= scene.height) {
        usage_error("--pixel {},{}: outside the picture of {}x{} pixels, counted from 0", options.x,
                    options.y, scene.width, scene.height);
    }
    return scene;
}

bool is_finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::string explanation(const ExplainOptions& options, const Scene& scene,
                        const ExplainedPixel& pixel, const std::vector<SampleTree>& trees) {
    if (options.json) {
        return json_text({{"format", "mirrorball-explain"},
                          {"version", 1},
                          {"path", printable(options.scene)},
                          {"scene_hash", hash_text(scene_hash(scene))},
                          {"width", scene.width},
                          {"height", scene.height},
                          {"aa", to_string(scene.aa)},
                          {"max_bounces", scene.max_bounces},
                          {"pixel", {options.x, options.y}},
                          {"color", {pixel.color.x, pixel.color.y, pixel.color.z}},
                          {"samples", ray_trees_json(trees)}});
    }
    return fmt::format("{}: pixel {},{} of {}x{}, {}: {:.5f} {:.5f} {:.5f}\n",
                       printable(options.scene), options.x, options.y, scene.width, scene.height,
                       to_string(scene.aa), pixel.color.x, pixel.color.y, pixel.color.z) +
           ray_trees_text(trees);
}

}  // namespace

int run_explain(const ExplainOptions& options) {
    const Scene scene = scene_to_explain(options);
    const FlatScene<double> flat = flatten<double>(scene);
    const ExplainedPixel pixel = explain_pixel(flat, options.x, options.y);
    print_result(explanation(options, scene, pixel, ray_trees(pixel, scene, flat)));
    return static_cast<int>(is_finite(pixel.color) ? ExitCode::done : ExitCode::non_finite);
}

}  // namespace rt
