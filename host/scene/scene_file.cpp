// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_file.h"

#include <fmt/format.h>

#include "host/base/error.h"
#include "host/base/text.h"
#include "host/scene/mistakes.h"
#include "host/scene/model.h"
#include "host/scene/text_file.h"

namespace rt {

extern const char* const cornell_box_scene;  // embedded by CMake

namespace {

constexpr std::size_t max_nff_bytes = std::size_t{1} << 30;

/// Whether a text may be a JSON scene: an object, after blanks, comments or a byte order mark.
bool may_be_json(std::string_view text) {
    const std::size_t at = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    return at != text.npos && (text[at] == '{' || text[at] == '/');
}

Scene load(const std::string& path) {
    if (path == stdin_scene) return parse_json_scene(read_stdin().view(), "stdin");
    const std::string ending = lower_extension(path);
    if (ending == ".obj" || ending == ".ply") return load_model_scene(path);
    const bool is_nff = ending == ".nff";
    const FileText text = read_text_file(path, is_nff ? max_nff_bytes : max_json_bytes);
    refuse_foreign(path, text.view());
    if (is_nff) return parse_nff_scene(text.view(), path);
    if (!ending.empty() && ending != ".json" && !may_be_json(text.view())) {
        throw Error(ExitCode::input,
                    fmt::format("{}: unknown extension '{}'; use .json, .nff, .obj or .ply",
                                printable(path), printable(ending)));
    }
    return parse_json_scene(text.view(), path);
}

/// Keeps a scene's notes few: the first 20, then "and 5 more notes".
void limit_notes(std::vector<std::string>& notes) {
    constexpr std::size_t most = Mistakes::max_count;
    if (notes.size() <= most) return;
    const std::size_t more = notes.size() - most;
    notes.resize(most);
    notes.push_back(fmt::format("and {}", counted(more, "more note", "more notes")));
}

}  // namespace

Scene load_scene(const std::string& path, const LightOverrides& light) {
    Scene scene = load(path);
    limit_notes(scene.notes);
    override_light(scene, light);
    return scene;
}

Scene load_default_scene(const LightOverrides& light) {
    Scene scene = parse_json_scene(cornell_box_scene, default_scene_path);
    override_light(scene, light);
    return scene;
}

void override_light(Scene& scene, const LightOverrides& light) {
    if (light.ambient_light) scene.ambient_light = *light.ambient_light;
    if (!light.light_scale) return;
    for (Scene::Light& of_scene : scene.lights) {
        if (!of_scene.has_own_intensity) of_scene.intensity = glm::dvec3(*light.light_scale);
    }
}

}  // namespace rt
