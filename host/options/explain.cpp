// SPDX-License-Identifier: Apache-2.0
#include "host/options/lists.h"
#include "host/options/verb_options.h"

namespace rt {

namespace {

constexpr int most_samples = 64;  // beyond, nobody reads the trees

AaMode parse_explained_aa(const std::string& text) {
    const auto mode = parse_aa_mode(text);
    if (!mode || mode->refines() || mode->samples() > most_samples) {
        refuse(text, "expected none, grid:N (N up to 8) or sobol:S (S up to 64)");
    }
    return *mode;
}

}  // namespace

void add_explain(const CommandLine& program, Options& options) {
    ExplainOptions& explain = options.explain;
    explain.settings.aa = grid_aa(1);
    const CommandLine verb =
        program.verb("explain", "show how a pixel got its color: the tree of its rays");
    verb.argument("SCENE", explain.scene, scene_help);
    verb.option(
        "--pixel", "X,Y", "the pixel, counted from 0 at the top left",
        [&](const std::string& text) {
            const auto numbers = parse_integers(text, ',');
            if (!numbers || numbers->size() != 2 || numbers->front() < 0 || numbers->back() < 0) {
                refuse(text, "expected x,y in pixels from the top left");
            }
            explain.x = numbers->front();
            explain.y = numbers->back();
        },
        true);
    add_size(verb, explain.settings.size);
    verb.value("--aa", "MODE", explain.settings.aa, parse_explained_aa,
               "none (default), grid:N or sobol:S: one tree per sample");
    verb.value("--max-bounces", "N", explain.settings.max_bounces,
               count_in(0, ExplainOptions::most_bounces), bounces_help);
    add_light_options(verb, explain.light);
    verb.flag("--json", explain.json, json_help);
    verb.when_chosen([&options] { options.verb = Verb::explain; });
}

}  // namespace rt
