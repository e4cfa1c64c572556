// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/verify_parts.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "host/base/error.h"
#include "host/journal/shares.h"
#include "host/picture/render_picture.h"
#include "host/process/stop_signal.h"
#include "host/scene/scene_file.h"

namespace rt {

namespace {

std::string scene_to_load(const JournalHeader& header, const std::string& scene) {
    std::error_code ignored;
    if (!scene.empty()) return scene;
    if (!header.scene_file.empty() && std::filesystem::exists(header.scene_file, ignored)) {
        return header.scene_file;
    }
    usage_error("--verify: cannot find the scene file{}; name it with --scene",
                header.scene_file.empty() ? "" : " " + header.scene_file);
}

/// Shares hand out the blocks of a region at random, so that any share is a sample of it.
Shares sample_of(const Rect& region, double share, std::uint64_t seed) {
    const auto blocks = static_cast<int>(share_blocks(region).size());
    const auto wanted = static_cast<int>(std::lround(share * blocks));
    Shares sample{std::vector<int>(static_cast<std::size_t>(std::clamp(wanted, 1, blocks))),
                  blocks};
    auto number = static_cast<int>(seed % static_cast<std::uint64_t>(blocks));
    for (int& chosen : sample.numbers) chosen = std::exchange(number, (number + 1) % blocks);
    std::sort(sample.numbers.begin(), sample.numbers.end());
    return sample;
}

}  // namespace

bool render_part_again(const MergedPicture& merged, const std::string& scene, double share,
                       const std::string& part) {
    const JournalHeader& header = merged.header;
    RenderSettings settings = settings_for(header.picture);
    settings.journal = part;
    settings.shares = sample_of(header.picture.region, share, merged.seed);
    settings.light.light_scale = header.light_scale;
    if (const auto& light = header.ambient_light) {
        settings.light.ambient_light = glm::dvec3((*light)[0], (*light)[1], (*light)[2]);
    }
    Scene loaded = load_scene(scene_to_load(header, scene), settings.light);
    apply_overrides(loaded, settings);
    return render_picture(loaded, settings, {threads_choice()}, {}, stop_flag()).stats.complete();
}

}  // namespace rt
