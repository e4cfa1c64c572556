// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

#include "host/base/error.h"
#include "host/base/files.h"
#include "host/base/hash.h"
#include "host/measure/timing.h"
#include "host/picture/crew.h"
#include "host/process/stop_signal.h"
#include "host/record/record.h"
#include "host/scene/scene_file.h"
#include "host/selftest/selftest.h"

namespace rt {

namespace {

namespace fs = std::filesystem;

constexpr const char* modes[] = {"none",     "grid:2",        "grid:3",
                                 "sobol:16", "adaptive:0.05", "edges:0.01"};
constexpr int width = 64;

/// The shipped scenes: next to the installed program, or to the build folder.
fs::path scenes_folder() {
    const fs::path folder =
        beside_program({"../share/mirrorball/scenes", "../../scenes"}, "cornell-box.json");
    if (!folder.empty()) return folder;
    throw Error(ExitCode::input, "the shipped scenes are not installed next to " +
                                     program_file().string() + "; install mirrorball again");
}

/// "cornell-box", "gallery/chain".
std::set<std::string> scenes_in(const fs::path& folder) {
    std::set<std::string> scenes;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const fs::path scene = entry.path().lexically_relative(folder).replace_extension();
        if (entry.path().extension() == ".json") scenes.insert(scene);
    }
    for (const char* other : {"golden", "scene.schema"}) scenes.erase(other);
    return scenes;
}

using Hashes = std::map<std::string, std::string>;

Hashes read_golden(const fs::path& folder) {
    std::ifstream in(folder / "golden.json");
    const Json json = Json::parse(in, nullptr, false);
    return json.is_object() ? json.value("pictures", Hashes()) : Hashes();
}

RenderSettings golden_settings(const GoldenPicture& picture) {
    RenderSettings settings = timed_settings();
    settings.precision = picture.precision;
    settings.aa = parse_aa_mode(picture.mode);
    return settings;
}

/// One program for all scenes.
KernelChoice all_features() {
    KernelChoice kernels;
    kernels.features = every_feature;
    kernels.any_samples = true;
    return kernels;
}

}  // namespace

std::string GoldenPicture::name() const {
    return fmt::format("{}/{}/{}", scene, mode, to_string(precision));
}

std::vector<GoldenPicture> golden_pictures() {
    const fs::path folder = scenes_folder();
    Hashes hashes = read_golden(folder);
    std::vector<GoldenPicture> pictures;
    for (const Precision precision : {Precision::float32, Precision::float64}) {
        for (const std::string& scene : scenes_in(folder)) {
            for (const char* mode : modes) {
                GoldenPicture& picture =
                    pictures.emplace_back(GoldenPicture{scene, mode, precision, ""});
                picture.hash = hashes[picture.name()];
            }
        }
    }
    return pictures;
}

Scene golden_scene(const GoldenPicture& picture) {
    Scene scene = load_scene(scenes_folder() / (picture.scene + ".json"));
    RenderSettings settings = golden_settings(picture);
    settings.size = PictureSize{width, std::max(1, width * scene.height / scene.width)};
    apply_overrides(scene, settings);
    return scene;
}

RenderedPicture render_golden(const GoldenPicture& picture, const DeviceChoice& device,
                              const KernelChoice& kernels, RenderCache* cache) {
    RenderSettings settings = golden_settings(picture);
    settings.kernels = kernels;
    const auto devices = [&] { return std::vector{device}; };
    return render_picture(golden_scene(picture), settings, devices, {}, stop_flag(), cache);
}

void check_pictures(Checks& checks, const DeviceChoice& device, const std::string& prefix,
                    bool quick) {
    const bool has_double = device.use_threads || device.device.has_double;
    RenderCache cache;
    const auto run = [&](const char* how, const GoldenPicture& picture,
                         const KernelChoice& kernels) {
        checks.run(prefix + how + "/" + picture.name(), [&]() -> std::string {
            const std::string hash =
                hash_text(render_golden(picture, device, kernels, &cache).stats.image_hash);
            if (hash == picture.hash) return "";
            return fmt::format("another picture: {} instead of {}", hash,
                               picture.hash.empty() ? "any of the golden ones" : picture.hash);
        });
    };
    KernelChoice own, samples;
    own.launch = Launch::pixel;
    samples.launch = Launch::sample;
    for (const GoldenPicture& picture : golden_pictures()) {
        const bool is_double = picture.precision == Precision::float64;
        const bool refines = !parse_aa_mode(picture.mode)->fixed_samples();
        if (is_double && !has_double) continue;
        if (quick && (is_double || refines)) continue;
        run("picture", picture, all_features());
        const bool is_paper = picture.scene == "cornell-box";
        if (device.use_threads || picture.mode != "grid:2" || is_double || !is_paper) continue;
        if (!quick) run("own-features", picture, own);
        run("samples", picture, samples);
    }
}

}  // namespace rt
