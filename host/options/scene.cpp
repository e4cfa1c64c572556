// SPDX-License-Identifier: Apache-2.0
#include "host/options/verb_options.h"

namespace rt {

namespace {

void add_scene_action(CLI::App& scene, const char* name, const char* help, bool info,
                      Options& options) {
    CLI::App& action = *scene.add_subcommand(name, help);
    action.add_option("SCENE", options.scene.scene, "scene file (.json, .nff, .obj, .ply)")
        ->required();
    add_light_options(action, options.scene.light);
    action.add_flag("--json", options.scene.json, "as JSON on stdout");
    action.callback([&options, info] {
        options.verb = Verb::scene;
        options.scene.info = info;
    });
}

}  // namespace

void add_scene(CLI::App& app, Options& options) {
    CLI::App& scene = *app.add_subcommand("scene", "look at a scene file");
    scene.require_subcommand(1);
    add_scene_action(scene, "info", "what the scene holds, needs, and leaves out", true, options);
    add_scene_action(scene, "check", "read the scene and say what is wrong with it", false,
                     options);
}

}  // namespace rt
