// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/cli/options.h"
#include "host/cli/render_pictures.h"
#include "host/flatten/flat_scene.h"
#include "host/print/print_stats.h"
#include "host/scene/scene_file.h"

namespace rt {

extern const char* const scene_schema;  // embedded by CMake

namespace {

/// `mirrorball scene info|check`
struct SceneOptions {
    std::string scene;
    LightOverrides light;
    bool json = false;
};

/// The corners of its bounding box; null if it is empty.
Json bounds_json(const Scene& scene) {
    const auto [low, high] = bounding_box(scene);
    if (low.x > high.x) return nullptr;
    return {{low.x, low.y, low.z}, {high.x, high.y, high.z}};
}

Json info_json(const std::string& path, const Scene& scene, const FlatScene<float>& flat) {
    Json json = {{"format", "mirrorball-scene-info"},
                 {"version", 1},
                 {"path", printable(path)},
                 {"name", scene.name},
                 {"hash", hash_text(scene_hash(scene))},
                 {"width", scene.width},
                 {"height", scene.height},
                 {"aa", to_string(scene.aa)},
                 {"max_bounces", scene.max_bounces}};
    for (const KindStats& kind : flat.stats.kinds()) json[kind.many] = kind.count;
    json.update({{"smooth_triangles", flat.vertex_normals.size()},
                 {"meshes", scene.meshes.size()},
                 {"mesh_triangles", triangle_count(scene) - scene.triangles.size()},
                 {"lights", scene.lights.size()},
                 {"lights_used", flat.lights.size()},
                 {"materials", scene.materials.size()},
                 {"bounds", bounds_json(scene)},
                 {"flat_bytes", flat.bytes()},
                 {"hierarchies", json_of(hierarchies_of(flat.stats))},
                 {"hierarchy_seconds", flat.stats.bvh_seconds},
                 {"shadow_casters", flat.stats.casters},
                 {"lit_triangles", flat.stats.lit_triangles},
                 {"features_used", names_of(flat.features, true)},
                 {"features_left_out", names_of(flat.features, false)},
                 {"notes", scene.notes},
                 {"warnings", scene_warnings(scene)}});
    return json;
}

std::string info_text(const Scene& scene, const FlatScene<float>& flat) {
    std::string text = fmt::format(
        "{}\n"
        "  hash       {}\n"
        "  picture    {}x{} pixels, {}, up to {}\n"
        "  contains   {} ({} smooth), {}, {}\n"
        "  on device  {} bytes in float\n",
        scene.name, hash_text(scene_hash(scene)), scene.width, scene.height, to_string(scene.aa),
        counted(static_cast<std::size_t>(scene.max_bounces), "mirror bounce"),
        kinds_text(flat.stats), flat.vertex_normals.size(),
        counted(scene.materials.size(), "material"), counted(scene.lights.size(), "light"),
        flat.bytes());
    if (!flat.triangles.empty()) {
        text += fmt::format(
            "             {:.1f} bytes per triangle\n",
            static_cast<double>(flat.bytes()) / static_cast<double>(flat.triangles.size()));
    }
    if (!scene.meshes.empty()) {
        text += fmt::format("  models     {}, {}\n", counted(scene.meshes.size(), "mesh", "meshes"),
                            counted(triangle_count(scene) - scene.triangles.size(), "triangle"));
    }
    if (const auto [low, high] = bounding_box(scene); low.x <= high.x) {
        text +=
            fmt::format("  reaches    from ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})\n",
                        low.x, low.y, low.z, high.x, high.y, high.z);
    }
    text += fmt::format("  needs      {}\n  leaves out {}\n", names_text(flat.features, true),
                        names_text(flat.features, false));
    std::istringstream built(flatten_text(flat.stats));
    for (std::string line; std::getline(built, line);) text += "  " + line + "\n";
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

std::string verdict_text(std::size_t warnings) {
    return warnings == 0 ? ": fine\n"
                         : ": can be rendered, with " + counted(warnings, "warning") + "\n";
}

/// Throws Error (input) where the camera path has a frame without a view.
void check_path(const Scene& scene) {
    if (scene.path.keys.empty()) return;
    const double last = std::min(scene.path.keys.back().frame, double{last_frame});
    for (double frame = 0; frame <= last; ++frame) camera_at(scene, frame);
}

int check_scene(const SceneOptions& options) {
    std::string mistakes;
    ExitCode code = ExitCode::done;
    std::vector<std::string> notes, warnings;
    try {
        const Scene scene = load_scene(options.scene, options.light);
        flatten<float>(scene);
        check_path(scene);
        notes = scene.notes;
        warnings = scene_warnings(scene);
    } catch (const Error& error) {
        code = error.exit_code();
        if (!options.json || (code != ExitCode::input && code != ExitCode::limit)) throw;
        mistakes = error.what();
    }
    print_result(options.json ? json_text(check_json(options.scene, mistakes, notes, warnings))
                              : printable(options.scene) + verdict_text(warnings.size()));
    if (!options.json) {
        print_notes(notes);
        print_warnings(options.scene, warnings);
    }
    return static_cast<int>(code);
}

using RunScene = int (*)(const SceneOptions&);

void add_scene_action(Verb& scene, const char* name, const char* help, RunScene run) {
    const auto asked = std::make_shared<SceneOptions>();
    Verb& action = scene.verb(name, help);
    action.argument("SCENE", asked->scene, scene_help);
    add_light_options(action, asked->light);
    action.flag("--json", asked->json, json_help);
    action.run = [=] { return run(*asked); };
}

}  // namespace

void add_scene(Verb& program, const Invocation&) {
    Verb& scene = program.verb("scene", "inspect a scene file");
    add_scene_action(scene, "info", "show what the scene contains, needs, and leaves out",
                     show_info);
    add_scene_action(scene, "check", "check the scene for errors", check_scene);
    Verb& schema = scene.verb("schema", "print the JSON Schema of scene files");
    schema.run = [] {
        print_result(scene_schema);
        return static_cast<int>(ExitCode::done);
    };
}

}  // namespace rt
