// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "host/base/console.h"
#include "host/base/counted.h"
#include "host/base/error.h"
#include "host/base/printable.h"
#include "host/flatten/flat_scene.h"
#include "host/picture/render_stats.h"
#include "host/print/flatten_text.h"
#include "host/print/print_stats.h"
#include "host/scene/scene_file.h"
#include "host/scene/scene_hash.h"
#include "host/scene/scene_warnings.h"
#include "host/verbs/verbs.h"

namespace rt {

namespace {

using Json = nlohmann::ordered_json;

Json info_json(const std::string& path, const Scene& scene, const FlatScene<float>& flat) {
    return {{"format", "mirrorball-scene-info"},
            {"version", 1},
            {"path", printable(path)},
            {"name", scene.name},
            {"hash", hash_text(scene_hash(scene))},
            {"width", scene.width},
            {"height", scene.height},
            {"aa", to_string(scene.aa)},
            {"max_bounces", scene.max_bounces},
            {"spheres", scene.spheres.size()},
            {"cones", scene.cones.size()},
            {"triangles", flat.triangles.size()},
            {"smooth_triangles", flat.vertex_normals.size()},
            {"meshes", scene.meshes.size()},
            {"mesh_triangles", triangle_count(scene) - scene.triangles.size()},
            {"lights", scene.lights.size()},
            {"lights_used", flat.lights.size()},
            {"materials", scene.materials.size()},
            {"flat_bytes", flat.bytes()},
            {"hierarchies", hierarchies_json(flat.stats)},
            {"hierarchy_seconds", flat.stats.bvh_seconds},
            {"shadow_casters", flat.stats.casters},
            {"lit_triangles", flat.stats.lit_triangles},
            {"features_used", names_of(flat.features, true)},
            {"features_left_out", names_of(flat.features, false)},
            {"notes", scene.notes},
            {"warnings", scene_warnings(scene)}};
}

std::string info_text(const Scene& scene, const FlatScene<float>& flat) {
    std::string text = fmt::format(
        "{}\n"
        "  hash       {}\n"
        "  picture    {}x{} pixels, {}, up to {}\n"
        "  contains   {}, {}, {} ({} smooth), {}, {}\n"
        "  on device  {} bytes in float\n",
        scene.name, hash_text(scene_hash(scene)), scene.width, scene.height, to_string(scene.aa),
        counted(static_cast<std::size_t>(scene.max_bounces), "mirror bounce"),
        counted(scene.spheres.size(), "sphere"), counted(scene.cones.size(), "cone"),
        counted(flat.triangles.size(), "triangle"), flat.vertex_normals.size(),
        counted(scene.materials.size(), "material"), counted(scene.lights.size(), "light"),
        flat.bytes());
    if (!flat.triangles.empty()) {
        text += fmt::format(
            "             {:.1f} bytes per triangle\n",
            static_cast<double>(flat.bytes()) / static_cast<double>(flat.triangles.size()));
    }
    if (!scene.meshes.empty()) {
        text += fmt::format("  meshes     {} of {}\n", scene.meshes.size(),
                            counted(triangle_count(scene) - scene.triangles.size(), "triangle"));
    }
    text += fmt::format("  builds     {}\n  casters    {}\n", hierarchies_text(flat.stats),
                        casters_text(flat.stats));
    for (const FeatureName& feature : feature_names) {
        const bool used = flat.features.*feature.flag;
        text += fmt::format("  {:<10} {}\n", used ? "needs" : "leaves out", feature.name);
    }
    if (flat.lights.size() < scene.lights.size()) {
        text += fmt::format("  ignores    {} that light nothing\n",
                            counted(scene.lights.size() - flat.lights.size(), "light"));
    }
    for (const std::string& note : scene.notes) text += fmt::format("  note       {}\n", note);
    for (const std::string& warning : scene_warnings(scene)) {
        text += fmt::format("  warning    {}\n", warning);
    }
    return text;
}

int show_info(const SceneOptions& options) {
    const Scene scene = load_scene(options.scene, options.light);
    const FlatScene<float> flat = flatten<float>(scene);
    print_result(options.json ? json_text(info_json(options.scene, scene, flat))
                              : info_text(scene, flat));
    return static_cast<int>(ExitCode::done);
}

Json check_json(const std::string& path, const std::string& mistakes,
                const std::vector<std::string>& notes, const std::vector<std::string>& warnings) {
    Json lines = Json::array();
    std::istringstream text(mistakes);
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return {{"format", "mirrorball-scene-check"},
            {"version", 1},
            {"path", printable(path)},
            {"fine", lines.empty()},
            {"mistakes", lines},
            {"notes", notes},
            {"warnings", warnings}};
}

void print_warnings(const std::string& path, const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) {
        print_note(fmt::format("{}: warning: {}", printable(path), warning));
    }
}

int check_scene(const SceneOptions& options) {
    std::string mistakes;
    std::vector<std::string> notes, warnings;
    try {
        const Scene scene = load_scene(options.scene, options.light);
        flatten<float>(scene);
        notes = scene.notes;
        warnings = scene_warnings(scene);
    } catch (const Error& error) {
        if (!options.json || error.exit_code() != ExitCode::input) throw;
        mistakes = error.what();
    }
    print_result(options.json ? json_text(check_json(options.scene, mistakes, notes, warnings))
                              : printable(options.scene) + ": fine\n");
    if (!options.json) {
        print_notes(notes);
        print_warnings(options.scene, warnings);
    }
    return static_cast<int>(mistakes.empty() ? ExitCode::done : ExitCode::input);
}

}  // namespace

int run_scene(const SceneOptions& options) {
    return options.info ? show_info(options) : check_scene(options);
}

}  // namespace rt
