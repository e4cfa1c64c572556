// SPDX-License-Identifier: Apache-2.0
#include "host/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdlib>
#include <limits>

#include "host/error.h"
#include "host/render/device_spec.h"
#include "host/version.h"

namespace rt {

namespace {

constexpr int largest_side = 65536;
constexpr std::int64_t most_pixels = std::int64_t{1} << 28;
constexpr int most_bounces = 100000;
constexpr int most_threads = 4096;

[[noreturn]] void refuse(const std::string& option, const std::string& value,
                         const char* expected) {
    throw Error(ExitCode::usage, fmt::format("{} '{}': {}", option, value, expected));
}

/// Numbers beyond int become its largest, for the range checks to refuse.
std::optional<std::vector<int>> parse_integers(std::string_view text, char separator) {
    std::vector<int> numbers;
    const char* at = text.data();
    const char* const end = text.data() + text.size();
    for (;;) {
        int number = 0;
        const auto [stop, error] = std::from_chars(at, end, number);
        if (error == std::errc::result_out_of_range) {
            number = std::numeric_limits<int>::max();
        } else if (error != std::errc{}) {
            return std::nullopt;
        }
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

std::string device_from_environment() {
    const std::string spec = environment("MIRRORBALL_DEVICE");
    try {
        check_device_spec(spec);
    } catch (const Error& error) {
        throw Error(error.exit_code(), std::string("in $MIRRORBALL_DEVICE: ") + error.what());
    }
    return spec;
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
struct Choice {
    const char* name;
    E value;
};

template <typename E>
void add_choice(CLI::App& app, const std::string& option, E& value,
                const std::vector<Choice<E>>& choices, const std::string& help) {
    std::string names;
    for (const Choice<E>& choice : choices) {
        names += (names.empty() ? "" : "|") + std::string(choice.name);
    }
    const auto read = [&value, choices, option, names](const std::string& text) {
        for (const Choice<E>& choice : choices) {
            if (text == choice.name) {
                value = choice.value;
                return;
            }
        }
        refuse(option, text, ("give one of " + names).c_str());
    };
    app.add_option_function<std::string>(option, read, help)->type_name(names);
}

template <typename Parse>
void add_text(CLI::App& app, const std::string& name, const char* type, const std::string& help,
              const Parse& parse) {
    app.add_option_function<std::string>(name, parse, help)->type_name(type);
}

void add_picture_options(CLI::App& app, RenderOptions& render) {
    add_text(app, "--size", "WxH|N", "pixels (default: the scene's)",
             [&](const std::string& text) { render.size = parse_size("--size", text); });
    add_text(app, "--aa", "none|grid:N",
             "samples of a pixel: its centre, or an N x N grid (default: the scene's)",
             [&](const std::string& text) { render.aa = parse_aa(text); });
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
           "mirror rays after the eye ray (default: the scene's)")
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
    add_choice<bool>(app, "--features", render.all_features, {{"auto", false}, {"all", true}},
                     "compile what the scene needs (default), or everything");
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

void add_render(CLI::App& app, Options& options) {
    CLI::App& verb = *app.add_subcommand("render", "render one picture");
    verb.add_option("SCENE", options.render.scene, "scene file (.json)")->required();
    add_text(verb, "-o,--output", "FILE", "picture file: .png, .exr or .pfm (default: none)",
             [&](const std::string& text) {
                 if (text.empty()) refuse("-o", text, "name a picture file");
                 options.render.output = text;
             });
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

/// The arguments in CLI11's order, last first. A bare --stats takes no value: the word after it may
/// be the scene.
std::vector<std::string> reversed_arguments(int argc, const char* const* argv) {
    std::vector<std::string> arguments;
    for (int i = argc - 1; i > 0; --i) {
        const std::string argument = argv[i];
        arguments.push_back(argument == "--stats" ? "--stats=text" : argument);
    }
    return arguments;
}

/// An unknown verb is named; CLI11 only says that one is missing.
void check_verb(const CLI::App& app, const std::vector<std::string>& reversed) {
    if (reversed.empty() || reversed.back().starts_with("-")) return;
    std::string verbs;
    for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
        if (verb->get_name() == reversed.back()) return;
        verbs += " " + verb->get_name();
    }
    throw Error(ExitCode::usage,
                fmt::format("unknown verb '{}'; there is:{}", reversed.back(), verbs));
}

}  // namespace

Options parse_options(int argc, const char* const* argv) {
    Options options;
    options.render.device = device_from_environment();
    options.render.pocl_cache = pocl_cache_folder();
    options.render.dumb_terminal = environment("TERM") == "dumb";
    CLI::App app("a headless OpenCL ray tracer that tells the truth about itself", "mirrorball");
    app.set_version_flag("--version", fmt::format("mirrorball {} ({})", version, git_revision));
    app.require_subcommand(1);
    add_render(app, options);
    add_devices(app, options);
    add_scene(app, options);
    try {
        std::vector<std::string> arguments = reversed_arguments(argc, argv);
        check_verb(app, arguments);
        app.parse(std::move(arguments));
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
