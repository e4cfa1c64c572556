// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/ablation.h"

#include "host/flatten/flat_scene.h"
#include "host/render/packet_shape.h"

namespace rt {

namespace {

constexpr std::size_t most_without_hierarchy = 5000;

using Changes = std::vector<Change>;

void add_features(const Features& needed, Changes& changes) {
    for (const FeatureName& feature : feature_names) {
        if (needed.*feature.flag) continue;
        changes.push_back(
            {std::string(feature.name) + " compiled in", [&feature](RenderSettings& settings) {
                 settings.kernels.features.*feature.flag = true;
             }});
    }
    if (changes.empty()) return;
    changes.push_back({"everything compiled in",
                       [](RenderSettings& settings) { settings.kernels.features = Features{}; }});
}

/// Whether some kind of primitive could have a hierarchy but has none.
bool lacks_hierarchy(const FlatScene<float>& flat) {
    return (flat.spheres.size() > 1 && flat.params.sphere_root == 0) ||
           (flat.cones.size() > 1 && flat.params.cone_root == 0) ||
           (flat.triangles.size() > 1 && flat.params.triangle_root == 0);
}

void add_hierarchies(const FlatScene<float>& flat, Changes& changes) {
    const std::size_t primitives = flat.spheres.size() + flat.cones.size() + flat.triangles.size();
    if (!flat.nodes.empty() && primitives <= most_without_hierarchy) {
        changes.push_back(
            {"no hierarchies", [](RenderSettings& settings) { settings.hierarchies = false; }});
    }
    if (lacks_hierarchy(flat)) {
        changes.push_back({"hierarchies over few primitives",
                           [](RenderSettings& settings) { settings.hierarchies = true; }});
    }
}

}  // namespace

std::vector<Change> changes_to_measure(const Scene& scene, const ListedDevice& device,
                                       Precision precision) {
    const FlatScene<float> flat = flatten<float>(scene);
    Changes changes;
    if (!device.is_threads) add_features(flat.features, changes);
    if (flat.stats.casters < flat.stats.lit_triangles) {
        changes.push_back(
            {"no caster lists", [](RenderSettings& settings) { settings.caster_lists = false; }});
    }
    add_hierarchies(flat, changes);
    const int lanes = precision == Precision::float32 ? device.float_lanes : device.double_lanes;
    if (lanes > 1) {
        const int samples = scene.aa.samples();
        if (packet_shape(lanes, samples).samples == samples) {
            changes.push_back({"a loop over samples", [](RenderSettings& settings) {
                                   settings.kernels.any_samples = true;
                               }});
        }
        changes.push_back({"one lane instead of " + std::to_string(lanes),
                           [](RenderSettings& settings) { settings.kernels.lanes = 1; }});
    }
    return changes;
}

}  // namespace rt
