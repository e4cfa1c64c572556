// SPDX-License-Identifier: Apache-2.0
#include "host/options/lists.h"
#include "host/options/parse.h"
#include "host/options/verb_options.h"

namespace rt {

namespace {

constexpr int most_samples = 64;  // beyond, nobody reads the trees

AaMode parse_explained_aa(const std::string& text) {
    const auto mode = parse_aa_mode(text);
    if (!mode || mode->refines() || mode->samples() > most_samples) {
        refuse("--aa", text, "give none, grid:N (N up to 8) or sobol:S (S up to 64)");
    }
    return *mode;
}

}  // namespace

void add_explain(const CommandLine& program, Options& options) {
    ExplainOptions& explain = options.explain;
    explain.settings.aa = grid_aa(1);
    const CommandLine verb =
        program.verb("explain", "show how a pixel got its color: the tree of its rays");
    verb.argument("SCENE", explain.scene, "scene file (.json, .nff, .obj, .ply)");
    verb.option(
        "--pixel", "X,Y", "the pixel, from the top left",
        [&](const std::string& text) {
            const auto numbers = parse_integers(text, ',');
            if (!numbers || numbers->size() != 2 || numbers->front() < 0 || numbers->back() < 0) {
                refuse("--pixel", text, "give x,y in pixels from the top left");
            }
            explain.x = numbers->front();
            explain.y = numbers->back();
        },
        true);
    verb.option(
        "--size", "WxH|N", "pixels of the picture (default: the scene's)",
        [&](const std::string& text) { explain.settings.size = parse_size("--size", text); });
    verb.option("--aa", "MODE", "none (default), grid:N or sobol:S: a tree for each sample",
                [&](const std::string& text) { explain.settings.aa = parse_explained_aa(text); });
    verb.option("--max-bounces", "N",
                "mirror and refracted rays after the eye ray (default: the scene's)",
                [&](const std::string& text) {
                    explain.settings.max_bounces =
                        parse_count("--max-bounces", text, 0, ExplainOptions::most_bounces);
                });
    add_light_options(verb, explain.light);
    verb.flag("--json", explain.json, "as JSON on stdout");
    verb.when_chosen([&options] { options.verb = Verb::explain; });
}

}  // namespace rt
