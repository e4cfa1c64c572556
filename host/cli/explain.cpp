// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/base/hash.h"
#include "host/cli/options.h"
#include "host/explain/ray_tree.h"
#include "host/record/record.h"
#include "host/scene/scene.h"
#include "host/scene/scene_file.h"

namespace rt {

namespace {

/// `mirrorball explain`
struct ExplainOptions {
    static constexpr int most_bounces = 256;  ///< deeper JSON is too much for most readers

    std::string scene;
    LightOverrides light;
    int x = 0, y = 0;         ///< the pixel, from the top left
    RenderSettings settings;  ///< only size, AA and bounces
    bool json = false, verbose = false;
};

Scene scene_to_explain(const ExplainOptions& options) {
    Scene scene = load_scene(options.scene, options.light);
    apply_overrides(scene, options.settings);
    if (scene.max_bounces > ExplainOptions::most_bounces) {
        throw Error(
            ExitCode::limit,
            fmt::format("{}: {} bounces are too many to explain; use --max-bounces {} or less",
                        printable(options.scene), scene.max_bounces, ExplainOptions::most_bounces));
    }
    if (options.x >= scene.width || options.y >= scene.height) {
        usage_error("--pixel {},{}: outside the picture of {}x{} pixels, counted from 0", options.x,
                    options.y, scene.width, scene.height);
    }
    return scene;
}

std::string explanation(const ExplainOptions& options, const Scene& scene,
                        const ExplainedPixel& pixel, const std::vector<SampleTree>& trees) {
    if (options.json) {
        return json_text({{"format", "mirrorball-explain"},
                          {"version", 1},
                          {"path", printable(options.scene)},
                          {"scene_hash", hash_text(scene_hash(scene))},
                          {"width", scene.width},
                          {"height", scene.height},
                          {"aa", to_string(scene.aa)},
                          {"max_bounces", scene.max_bounces},
                          {"pixel", {options.x, options.y}},
                          {"color", {pixel.color.x, pixel.color.y, pixel.color.z}},
                          {"samples", json_of(trees)}});
    }
    return fmt::format("{}: pixel {},{} of {}x{}, {}: {:.5f} {:.5f} {:.5f}\n",
                       printable(options.scene), options.x, options.y, scene.width, scene.height,
                       to_string(scene.aa), pixel.color.x, pixel.color.y, pixel.color.z) +
           ray_trees_text(trees, options.verbose);
}

int run_explain(const ExplainOptions& options) {
    const Scene scene = scene_to_explain(options);
    const FlatScene<double> flat = flatten<double>(scene);
    const ExplainedPixel pixel = explain_pixel(flat, options.x, options.y);
    print_result(explanation(options, scene, pixel, ray_trees(pixel, scene, flat)));
    const glm::dvec3 c = pixel.color;
    const bool is_finite = std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
    return static_cast<int>(is_finite ? ExitCode::done : ExitCode::non_finite);
}

constexpr int most_samples = 64;  // beyond, nobody reads the trees

AaMode parse_explained_aa(const std::string& text) {
    const auto mode = parse_aa_mode(text);
    if (!mode || !mode->fixed_samples() || mode->samples() > most_samples) {
        refuse(text, "expected none, grid:N (N up to 8) or sobol:S (S up to 64)");
    }
    return *mode;
}

}  // namespace

void add_explain(Verb& program, const Invocation&) {
    const auto asked = std::make_shared<ExplainOptions>();
    ExplainOptions& explain = *asked;
    explain.settings.aa = grid_aa(1);
    Verb& verb = program.verb("explain", "show how a pixel got its color: the tree of its rays");
    verb.argument("SCENE", explain.scene, scene_help);
    verb.option(
        "--pixel", "X,Y", "the pixel, counted from 0 at the top left",
        [&explain](const std::string& text) {
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
    verb.flag("-v,--verbose", explain.verbose, "also show rays of weight below 0.004");
    verb.flag("--json", explain.json, json_help);
    verb.run = [asked] { return run_explain(*asked); };
}

}  // namespace rt
