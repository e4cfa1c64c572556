// SPDX-License-Identifier: Apache-2.0
#include "host/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdlib>
#include <map>

#include "host/error.h"
#include "host/version.h"

namespace rt {

namespace {

constexpr int largest_side = 65536;
constexpr std::int64_t most_pixels = std::int64_t{1} << 28;
constexpr int most_bounces = 100000;

[[noreturn]] void refuse(const std::string& option, const std::string& value,
                         const char* expected) {
    throw Error(ExitCode::usage, fmt::format("{} '{}': {}", option, value, expected));
}

std::optional<std::vector<int>> parse_integers(std::string_view text, char separator) {
    std::vector<int> numbers;
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    for (;;) {
        int number = 0;
        const auto [stop, error] = std::from_chars(at, end, number);
        if (error != std::errc{}) return std::nullopt;
        numbers.push_back(number);
        if (stop == end) return numbers;
        if (*stop != separator) return std::nullopt;
        at = stop + 1;
    }
}

PictureSize parse_size(const std::string& option, const std::string& text) {
    const auto numbers = parse_integers(text, 'x');
    if (!numbers || numbers->size() > 2) {
        refuse(option, text, "give WIDTHxHEIGHT or N, in pixels, as in 640x480 or 500");
    }
    const PictureSize size{numbers->front(), numbers->back()};
    if (size.width < 1 || size.height < 1) refuse(option, text, "a side must be at least 1 pixel");
    if (size.width > largest_side || size.height > largest_side ||
        std::int64_t{size.width} * size.height > most_pixels) {
        throw Error(ExitCode::limit,
                    fmt::format("{} '{}': a side may have at most {} pixels, a picture {}", option,
                                text, largest_side, most_pixels));
    }
    return size;
}

AaMode parse_aa(const std::string& text) {
    const auto mode = parse_aa_mode(text);
    if (!mode) refuse("--aa", text, "give none or grid:N with N from 1 to 64");
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

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
}

/// Where PoCL keeps its kernels: the rule of its own documentation.
std::string pocl_cache_folder() {
    if (const std::string own = environment("POCL_CACHE_DIR"); !own.empty()) return own;
    if (const std::string xdg = environment("XDG_CACHE_HOME"); !xdg.empty()) {
        return xdg + "/pocl/kcache";
    }
    const std::string home = environment("HOME");
    return home.empty() ? "" : home + "/.cache/pocl/kcache";
}

template <typename E>
CLI::Option* add_choice(CLI::App& app, const std::string& name, E& value,
                        const std::map<std::string, E>& choices, const std::string& help) {
    std::string names;
    for (const auto& choice : choices) names += (names.empty() ? "" : "|") + choice.first;
    return app
        .add_option_function<std::string>(
            name,
            [&value, choices, name, names](const std::string& text) {
                const auto found = choices.find(text);
                if (found == choices.end()) {
                    throw Error(ExitCode::usage,
                                fmt::format("{} '{}': give one of {}", name, text, names));
                }
                value = found->second;
            },
            help)
        ->type_name(names);
}

template <typename Parse>
void add_text(CLI::App& app, const std::string& name, const char* type, const std::string& help,
              const Parse& parse) {
    app.add_option_function<std::string>(name, parse, help)->type_name(type);
}

void add_picture_options(CLI::App& app, RenderOptions& render) {
    add_text(app, "--size", "WxH|N", "pixels",
             [&](const std::string& text) { render.size = parse_size("--size", text); });
    add_text(app, "--aa", "none|grid:N", "samples per pixel: its centre, or an N x N grid",
             [&](const std::string& text) { render.aa = parse_aa(text); });
    add_text(app, "--crop", "x0,y0,x1,y1", "render a window of the picture",
             [&](const std::string& text) { render.crop = parse_crop(text); });
    app.add_option_function<int>(
           "--max-bounces",
           [&](int bounces) {
               if (bounces < 0 || bounces > most_bounces) {
                   refuse("--max-bounces", std::to_string(bounces), "give 0 to 100000");
               }
               render.max_bounces = bounces;
           },
           "mirror rays after the eye ray")
        ->type_name("N");
    add_text(app, "--encoding", "display|srgb|linear", "how 8-bit files store linear light",
             [&](const std::string& text) { render.encoding = parse_encoding(text); });
    app.add_option("--reference", render.reference, "also print the error against this picture");
}

void add_device_options(CLI::App& app, RenderOptions& render) {
    app.add_option("--device", render.device,
                   "index, platform:device, pocl, name:TEXT, cpu, gpu, threads[:N]")
        ->type_name("SPEC");
    add_choice<Precision>(app, "--precision", render.precision,
                          {{"float", Precision::float32}, {"double", Precision::float64}},
                          "arithmetic");
    add_choice<bool>(app, "--math", render.fast_math, {{"strict", false}, {"fast", true}},
                     "strict: the same bits everywhere");
    add_choice<Launch>(app, "--launch", render.launch,
                       {{"pixel", Launch::pixel}, {"sample", Launch::sample}},
                       "what an OpenCL work item is");
    add_choice<Schedule>(app, "--schedule", render.schedule,
                         {{"tiles", Schedule::tiles}, {"buffers", Schedule::buffers}},
                         "pthreads: shared tiles, or a thread per sample buffer");
    app.add_option("--threads", render.threads, "threads of the pthreads renderer")
        ->check(CLI::Range(1, 4096))
        ->type_name("N");
    add_text(app, "--tile", "WxH|N", "pixels handed out at once",
             [&](const std::string& text) { render.tile = parse_size("--tile", text); });
    add_choice<bool>(app, "--features", render.all_features, {{"auto", false}, {"all", true}},
                     "compile what the scene needs, or everything");
    app.add_flag("!--no-fallback", render.fallback,
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
                             "on stderr");
    app.add_flag("-q,--quiet", render.quiet, "errors only");
    app.add_flag("-v,--verbose", render.verbose, "say more");
}

void add_render(CLI::App& app, Options& options) {
    CLI::App& verb = *app.add_subcommand("render", "render one picture");
    verb.add_option("SCENE", options.render.scene, "scene file (.json)")->required();
    verb.add_option("-o,--output", options.render.output, "picture file: .png, .exr or .pfm");
    add_picture_options(verb, options.render);
    add_device_options(verb, options.render);
    add_report_options(verb, options.render);
    verb.callback([&] { options.verb = Verb::render; });
}

void add_devices(CLI::App& app, Options& options) {
    CLI::App& verb =
        *app.add_subcommand("devices", "what can render here, and why something cannot");
    verb.add_flag("--json", options.devices.json, "as JSON on stdout");
    verb.callback([&] { options.verb = Verb::devices; });
}

void add_scene_action(CLI::App& scene, const char* name, const char* help, bool info,
                      Options& options) {
    CLI::App& action = *scene.add_subcommand(name, help);
    action.add_option("SCENE", options.scene.scene, "scene file (.json)")->required();
    action.add_flag("--json", options.scene.json, "as JSON on stdout");
    action.callback([&options, info] {
        options.verb = Verb::scene;
        options.scene.info = info;
    });
}

void add_scene(CLI::App& app, Options& options) {
    CLI::App& scene = *app.add_subcommand("scene", "look at a scene file");
    scene.require_subcommand(1);
    add_scene_action(scene, "info", "what the scene holds, needs, and leaves out", true, options);
    add_scene_action(scene, "check", "read the scene and say what is wrong with it", false,
                     options);
}

}  // namespace

Options parse_options(int argc, const char* const* argv) {
    Options options;
    options.render.device = environment("MIRRORBALL_DEVICE");
    options.render.pocl_cache = pocl_cache_folder();
    options.render.dumb_terminal = environment("TERM") == "dumb";
    CLI::App app("a headless OpenCL ray tracer that tells the truth about itself", "mirrorball");
    app.set_version_flag("--version", fmt::format("mirrorball {} ({})", version, git_revision));
    app.require_subcommand(1);
    add_render(app, options);
    add_devices(app, options);
    add_scene(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        options.text = app.help();
    } catch (const CLI::CallForAllHelp&) {
        options.text = app.help("", CLI::AppFormatMode::All);
    } catch (const CLI::CallForVersion&) {
        options.text = app.version() + "\n";
    } catch (const CLI::ParseError& error) {
        throw Error(
            ExitCode::usage,
            fmt::format("{}; see 'mirrorball --help' or 'mirrorball VERB --help'", error.what()));
    }
    return options;
}

}  // namespace rt
