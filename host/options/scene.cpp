// SPDX-License-Identifier: Apache-2.0
#include "host/options/lists.h"
#include "host/options/verb_options.h"

namespace rt {

namespace {

void add_scene_action(const CommandLine& scene, const char* name, const char* help, bool info,
                      Options& options) {
    const CommandLine action = scene.verb(name, help);
    action.argument("SCENE", options.scene.scene, scene_help);
    add_light_options(action, options.scene.light);
    action.flag("--json", options.scene.json, json_help);
    action.when_chosen([&options, info] {
        options.verb = Verb::scene;
        options.scene.info = info;
    });
}

}  // namespace

void add_scene(const CommandLine& program, Options& options) {
    const CommandLine scene = program.verb("scene", "inspect a scene file");
    add_scene_action(scene, "info", "show what the scene contains, needs, and leaves out", true,
                     options);
    add_scene_action(scene, "check", "check the scene for errors", false, options);
}

}  // namespace rt
