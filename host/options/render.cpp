// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "host/error.h"
#include "host/options/lists.h"
#include "host/options/parse.h"
#include "host/options/verb_options.h"
#include "host/render/device_spec.h"

namespace rt {

namespace {

constexpr int most_bounces = 100000;
constexpr int most_threads = 4096;

AaMode parse_aa(const std::string& text) {
    const auto mode = parse_aa_mode(text);
    if (!mode) refuse("--aa", text, std::string("give ") + aa_mode_help);
    return *mode;
}

/// x0,y0,x1,y1 in pixels from the top left, x1 and y1 not included.
Rect parse_crop(const std::string& text) {
    const auto n = parse_integers(text, ',');
    if (!n || n->size() != 4 || (*n)[0] < 0 || (*n)[1] < 0 || (*n)[2] <= (*n)[0] ||
        (*n)[3] <= (*n)[1]) {
        refuse("--crop", text, "give x0,y0,x1,y1 in pixels from the top left, with x0<x1, y0<y1");
    }
    return {(*n)[0], (*n)[1], (*n)[2] - (*n)[0], (*n)[3] - (*n)[1]};
}

std::string device_from_environment() {
    const std::string spec = environment("MIRRORBALL_DEVICE");
    try {
        check_device_spec(spec);
    } catch (const Error& error) {
        throw Error(error.exit_code(), std::string("in $MIRRORBALL_DEVICE: ") + error.what());
    }
    return spec;
}

/// "all", "auto", or names as of --stats with hyphens for blanks.
void parse_features(const std::string& text, RenderOptions& render) {
    render.all_features = text == "all";
    render.also_features = no_features();
    if (text == "all" || text == "auto") return;
    for (const std::string& part : split_list("--features", text)) {
        const FeatureName* found = nullptr;
        std::string names;
        for (const FeatureName& feature : feature_names) {
            std::string name = feature.name;
            std::replace(name.begin(), name.end(), ' ', '-');
            if (name == part) found = &feature;
            names += ", " + name;
        }
        if (found == nullptr)
            refuse("--features", part, "give auto, all or some of " + names.substr(2));
        render.also_features.*found->flag = true;
    }
}

void add_picture_options(CLI::App& app, RenderOptions& render) {
    add_text(app, "--size", "WxH|N", "pixels (default: the scene's)",
             [&](const std::string& text) { render.size = parse_size("--size", text); });
    add_text(app, "--aa", "MODE",
             std::string("samples of a pixel: ") + aa_mode_help + " (default: the scene's)",
             [&](const std::string& text) { render.aa = parse_aa(text); });
    add_choice<Filter>(app, "--filter", render.filter,
                       {{"box", Filter::box},
                        {"tent", Filter::tent},
                        {"gaussian", Filter::gaussian},
                        {"mitchell", Filter::mitchell}},
                       "how samples are weighed (default box)");
    add_text(app, "--crop", "x0,y0,x1,y1",
             "render a window: pixels from the top left, x1 and y1 not included",
             [&](const std::string& text) { render.crop = parse_crop(text); });
    app.add_option_function<int>(
           "--max-bounces",
           [&](int bounces) {
               if (bounces < 0 || bounces > most_bounces) {
                   refuse("--max-bounces", std::to_string(bounces), "give 0 to 100000");
               }
               render.max_bounces = bounces;
           },
           "mirror and refracted rays after the eye ray (default: the scene's)")
        ->type_name("N");
    add_text(app, "--encoding", "display|srgb|linear",
             "how 8-bit files store linear light (default display: value x 255)",
             [&](const std::string& text) { render.encoding = parse_encoding(text); });
    app.add_option("--reference", render.reference, "also print the error against this picture");
}

void add_device_options(CLI::App& app, RenderOptions& render) {
    add_text(app, "--device", "SPEC",
             "index, platform:device, pocl, name:TEXT, cpu, gpu or threads[:N] (default: "
             "$MIRRORBALL_DEVICE, else the best there is)",
             [&](const std::string& text) {
                 check_device_spec(text);
                 render.device = text;
             });
    add_choice<Precision>(app, "--precision", render.precision,
                          {{"float", Precision::float32}, {"double", Precision::float64}},
                          "arithmetic (default float)");
    add_choice<bool>(app, "--math", render.fast_math, {{"strict", false}, {"fast", true}},
                     "strict (default): the same bits everywhere; fast: the compiler may contract");
    add_choice<Launch>(app, "--launch", render.launch,
                       {{"pixel", Launch::pixel}, {"sample", Launch::sample}},
                       "what an OpenCL work item is (default: pixel on CPUs, sample elsewhere)");
    add_choice<int>(app, "--lanes", render.lanes,
                    {{"auto", 0}, {"1", 1}, {"2", 2}, {"4", 4}, {"8", 8}, {"16", 16}},
                    "rays an OpenCL work item traces side by side (default: a CPU's vector width, "
                    "else 1)");
    add_choice<Schedule>(app, "--schedule", render.schedule,
                         {{"tiles", Schedule::tiles}, {"buffers", Schedule::buffers}},
                         "pthreads: shared tiles (default), or a thread per sample buffer");
    app.add_option_function<int>(
           "--threads",
           [&](int threads) {
               if (threads < 1 || threads > most_threads) {
                   refuse("--threads", std::to_string(threads), "give 1 to 4096");
               }
               render.threads = threads;
           },
           "threads of the pthreads renderer, and of PoCL (default: all cores)")
        ->type_name("N");
    add_text(app, "--tile", "WxH|N", "pixels handed out at once",
             [&](const std::string& text) { render.tile = parse_size("--tile", text); });
    add_text(app, "--features", "auto|all|LIST",
             "compile what the scene needs (default), everything, or what it needs and these",
             [&](const std::string& text) { parse_features(text, render); });
    add_choice<std::optional<bool>>(app, "--hierarchies", render.hierarchies,
                                    {{"auto", std::nullopt}, {"on", true}, {"off", false}},
                                    "over which kinds of primitives: those with enough (default), "
                                    "two or more, none");
    add_choice<bool>(app, "--caster-lists", render.caster_lists, {{"on", true}, {"off", false}},
                     "list the triangles that cast shadows, where there are few (default on)");
    app.add_flag("--no-fallback", render.no_fallback,
                 "fail when the device fails, instead of finishing on threads");
}

void add_report_options(CLI::App& app, RenderOptions& render) {
    app.add_option_function<std::string>(
           "--stats",
           [&](const std::string& text) {
               if (text != "text" && text != "json") refuse("--stats", text, "give text or json");
               render.stats = text == "json" ? StatsFormat::json : StatsFormat::text;
           },
           "phases, rays, features used and left out, on stdout")
        ->expected(0, 1)
        ->default_str("text")
        ->type_name("text|json");
    add_choice<ProgressMode>(app, "--progress", render.progress,
                             {{"auto", ProgressMode::automatic},
                              {"bar", ProgressMode::bar},
                              {"plain", ProgressMode::plain},
                              {"json", ProgressMode::json},
                              {"none", ProgressMode::none}},
                             "on stderr (default auto: a bar on a terminal, else lines)");
    app.add_flag("-q,--quiet", render.quiet, "errors only");
    app.add_flag("-v,--verbose", render.verbose, "say more");
}

}  // namespace

void add_render(CLI::App& app, Options& options) {
    options.render.device = device_from_environment();
    options.render.dumb_terminal = environment("TERM") == "dumb";
    CLI::App& verb = *app.add_subcommand("render", "render one picture");
    verb.add_option("SCENE", options.render.scene, "scene file (.json, .nff, .obj, .ply)")
        ->required();
    add_text(verb, "-o,--output", "FILE", "picture file: .png, .exr or .pfm (default: none)",
             [&](const std::string& text) {
                 if (text.empty()) refuse("-o", text, "name a picture file");
                 options.render.output = text;
             });
    add_picture_options(verb, options.render);
    add_light_options(verb, options.render.light);
    add_device_options(verb, options.render);
    add_report_options(verb, options.render);
    verb.callback([&] { options.verb = Verb::render; });
}

}  // namespace rt
