// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_file.h"

#include "host/base/lower.h"
#include "host/scene/json_file.h"
#include "host/scene/model_file.h"
#include "host/scene/nff_file.h"
#include "host/scene/stdin_text.h"

namespace rt {
namespace {

Scene load(const std::string& path) {
    if (path == stdin_scene) return parse_json_scene(read_stdin().view(), "stdin");
    const std::string ending = lower_extension(path);
    if (ending == ".nff") return load_nff_scene(path);
    if (ending == ".obj" || ending == ".ply") return load_model_scene(path);
    return load_json_scene(path);
}

}  // namespace

Scene load_scene(const std::string& path, const LightOverrides& light) {
    Scene scene = load(path);
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
