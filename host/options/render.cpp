// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "host/error.h"
#include "host/opencl/device_spec.h"
#include "host/options/lists.h"
#include "host/options/parse.h"
#include "host/options/picture_output.h"
#include "host/options/settle_render.h"
#include "host/options/verb_options.h"
#include "host/render/native_kernels.h"

namespace rt {

namespace {

constexpr int most_bounces = 100000;
constexpr int most_threads = 4096;

AaMode parse_aa(const std::string& text) {
    const auto mode = parse_aa_mode(text);
    if (!mode) refuse("--aa", text, std::string("give ") + aa_mode_help);
    return *mode;
}

/// x0,y0,x1,y1 in pixels from the top left; x1 and y1 are exclusive.
Rect parse_crop(const std::string& text) {
    const auto n = parse_integers(text, ',');
    if (!n || n->size() != 4 || (*n)[0] < 0 || (*n)[1] < 0 || (*n)[2] <= (*n)[0] ||
        (*n)[3] <= (*n)[1]) {
        refuse("--crop", text, "give x0,y0,x1,y1 in pixels from the top left, with x0<x1, y0<y1");
    }
    return {(*n)[0], (*n)[1], (*n)[2] - (*n)[0], (*n)[3] - (*n)[1]};
}

/// "1-240" or "1,5,10-20", ascending.
std::vector<int> parse_frames(const std::string& text) {
    constexpr const char* expected = "give frames from 0 to 999999, ascending: 1-240 or 1,5,10-20";
    constexpr int last_frame = 999999;
    std::vector<int> frames;
    for (const std::string& part : split_list("--frames", text)) {
        const auto ends = parse_integers(part, '-');
        if (!ends || ends->size() > 2 || ends->back() > last_frame)
            refuse("--frames", text, expected);
        const int first = ends->front();
        if (first < 0 || ends->back() < first || (!frames.empty() && first <= frames.back())) {
            refuse("--frames", text, expected);
        }
        for (int frame = first; frame <= ends->back(); ++frame) frames.push_back(frame);
    }
    return frames;
}

std::string parse_isa(const std::string& text) {
    const std::vector<std::string> isas = native_isas();
    if (text == "auto") return "";
    if (std::find(isas.begin(), isas.end(), text) == isas.end()) {
        refuse_choice("--isa", text, isas);
    }
    return text;
}

std::string device_from_environment() {
    const std::string spec = environment("MIRRORBALL_DEVICE");
    try {
        check_device_list(spec);
    } catch (const Error& error) {
        throw Error(error.exit_code(), std::string("in $MIRRORBALL_DEVICE: ") + error.what());
    }
    return spec;
}

/// "all", "auto", or names as in --stats with hyphens for blanks.
void parse_features(const std::string& text, RenderOptions& render) {
    render.all_features = text == "all";
    render.also_features = no_features();
    if (text == "all" || text == "auto") return;
    for (const std::string& part : split_list("--features", text)) {
        const FeatureName* found = nullptr;
        std::vector<std::string> names;
        if (part == text) names = {"auto", "all"};
        for (const FeatureName& feature : feature_names) {
            std::string name = feature.name;
            std::replace(name.begin(), name.end(), ' ', '-');
            if (name == part) found = &feature;
            names.push_back(std::move(name));
        }
        if (found == nullptr) refuse_choice("--features", part, names);
        render.also_features.*found->flag = true;
    }
}

void add_picture_options(const CommandLine& verb, RenderOptions& render) {
    verb.option("--size", "WxH|N", "pixels (default: the scene's)",
                [&](const std::string& text) { render.size = parse_size("--size", text); });
    verb.option("--aa", "MODE",
                std::string("samples per pixel: ") + aa_mode_help + " (default: the scene's)",
                [&](const std::string& text) { render.aa = parse_aa(text); });
    add_choice<Filter>(verb, "--filter", render.filter,
                       {{"box", Filter::box},
                        {"tent", Filter::tent},
                        {"gaussian", Filter::gaussian},
                        {"mitchell", Filter::mitchell}},
                       "reconstruction filter (default box)");
    verb.option("--crop", "x0,y0,x1,y1",
                "render only a window: pixels from the top left, excluding x1 and y1",
                [&](const std::string& text) { render.crop = parse_crop(text); });
    verb.option("--max-bounces", "N",
                "mirror and refracted rays after the eye ray (default: the scene's)",
                [&](const std::string& text) {
                    render.max_bounces = parse_count("--max-bounces", text, 0, most_bounces);
                });
    verb.option("--shard", "I/N",
                "render only some of N shares, into a part file (-o FILE.mbj) for `mirrorball "
                "merge`: 7/64 or 7,9,20-25/64, counted from 0",
                [&](const std::string& text) {
                    render.shares = parse_shares(text);
                    if (!render.shares) {
                        refuse("--shard", text,
                               "give numbers from 0 to N - 1, and N: 7/64 or 7,9,20-25/64");
                    }
                });
    verb.option("--frames", "LIST",
                "render frames of the scene's camera path, each to its own picture (-o "
                "out.%04d.png): 1-240 or 1,5,10-20; with --shard I/N only every N-th frame; with "
                "--resume only the missing ones",
                [&](const std::string& text) { render.frames = parse_frames(text); });
    verb.flag("--mpi", render.mpi,
              "render on all the ranks that mpirun started, which must see the output's folder");
    verb.option(
        "--timeout", "S", "stop after S seconds and save what is finished",
        [&](const std::string& text) { render.timeout = parse_seconds("--timeout", text, 0.001); });
    verb.flag("--watch", render.watch,
              "render again whenever the scene's file or one of its models changes, until Ctrl-C "
              "or, with --show, until the window is closed");
    verb.flag("--fresh", render.fresh,
              "ignore what an interrupted render left in FILE.mbj next to the output");
    verb.flag("--resume", render.resume,
              "save finished tiles in FILE.mbj from the start, not only after 2 s");
    add_encoding(verb, render.encoding);
    add_name(verb, "--reference", "FILE", render.reference,
             "also print the error against this picture");
}

void add_device_options(const CommandLine& verb, RenderOptions& render) {
    verb.option(
        "--device", "SPEC",
        "index, platform:device, pocl, name:TEXT, cpu, gpu, threads[:N] or all; several, separated "
        "by commas, share the picture (default: $MIRRORBALL_DEVICE, else the best available)",
        [&](const std::string& text) {
            if (text.empty()) refuse("--device", text, "name a device, or auto");
            check_device_list(text);
            render.device = text;
        });
    add_choice<Precision>(verb, "--precision", render.precision,
                          {{"float", Precision::float32}, {"double", Precision::float64}},
                          "arithmetic (default float)");
    add_choice<bool>(verb, "--math", render.fast_math, {{"strict", false}, {"fast", true}},
                     "strict (default): the same bits everywhere; fast: the compiler may contract");
    add_choice<Launch>(
        verb, "--launch", render.launch, {{"pixel", Launch::pixel}, {"sample", Launch::sample}},
        "what an OpenCL work item renders (default: pixel on CPUs, sample elsewhere)");
    add_choice<int>(verb, "--lanes", render.lanes,
                    {{"auto", 0}, {"1", 1}, {"2", 2}, {"4", 4}, {"8", 8}, {"16", 16}},
                    "rays per packet (default: a CPU's vector width; 1 on GPUs)");
    verb.option(
        "--isa", "NAME",
        "instruction set of the threads' kernels, as `devices` lists them (default: the best)",
        [&](const std::string& text) { render.isa = parse_isa(text); });
    add_choice<Schedule>(verb, "--schedule", render.schedule,
                         {{"tiles", Schedule::tiles}, {"buffers", Schedule::buffers}},
                         "pthreads: shared tiles (default), or one thread per sample buffer");
    add_count(verb, "--threads", render.threads, 1, most_threads,
              "number of threads for pthreads and for PoCL (default: all cores)");
    verb.option("--tile", "WxH|N", "tile size in pixels (default: chosen by the device)",
                [&](const std::string& text) { render.tile = parse_size("--tile", text); });
    verb.option("--features", "auto|all|LIST",
                "compile what the scene needs (default), everything, or what it needs plus LIST",
                [&](const std::string& text) { parse_features(text, render); });
    add_choice<std::optional<bool>>(
        verb, "--hierarchies", render.hierarchies,
        {{"auto", std::nullopt}, {"on", true}, {"off", false}},
        "build bounding volume hierarchies: auto (where they are faster, default), on, off");
    add_choice<bool>(verb, "--caster-lists", render.caster_lists, {{"on", true}, {"off", false}},
                     "list the triangles that can cast shadows, if there are few (default on)");
    add_choice<bool>(verb, "--isolate", render.isolate, {{"auto", true}, {"never", false}},
                     "load OpenCL drivers in a separate process (default auto: yes)");
    verb.option(
        "--deadline", "S",
        "seconds without progress after which a driver counts as hung (default 10)",
        [&](const std::string& text) { render.deadline = parse_seconds("--deadline", text, 0.5); });
    verb.flag("--no-fallback", render.no_fallback,
              "fail if the device fails, instead of finishing on threads");
    verb.option(
        "--check", "P%", "trace P% of a device's or a journal's tiles again on threads and compare",
        [&](const std::string& text) { render.check = parse_percent("--check", text, 100); });
}

void add_report_options(const CommandLine& verb, RenderOptions& render) {
    const auto is_format = [](const std::string& text) { return text == "text" || text == "json"; };
    verb.optional_value("--stats", "text|json",
                        "phases, rays, features used and left out, on stdout", "text", is_format,
                        [&render, is_format](const std::string& text) {
                            if (!is_format(text)) refuse_choice("--stats", text, {"text", "json"});
                            render.stats = text == "json" ? StatsFormat::json : StatsFormat::text;
                        });
    add_choice<ProgressMode>(verb, "--progress", render.progress,
                             {{"auto", ProgressMode::automatic},
                              {"bar", ProgressMode::bar},
                              {"plain", ProgressMode::plain},
                              {"json", ProgressMode::json},
                              {"none", ProgressMode::none}},
                             "on stderr (default auto: a bar on a terminal, else lines)");
    add_aov(verb, render.aovs);
    add_view_options(verb, render.view);
    verb.flag("-q,--quiet", render.quiet, "print only errors");
    verb.flag("-v,--verbose", render.verbose, "print more");
}

}  // namespace

void add_render(const CommandLine& program, Options& options) {
    options.render.dumb_terminal = environment("TERM") == "dumb";
    const CommandLine verb = program.verb("render", "render a picture, or several");
    verb.arguments("SCENE", options.render.scenes,
                   "scene files (.json, .nff, .obj, .ply), or - for JSON from standard input",
                   false);
    add_picture_output(verb, options.render.output, options.render.format,
                       "picture file: .png, .exr, .pfm, .tif, .jpg, ... (default: none), or - for "
                       "standard output; for several scenes, %s stands for the scene's name: "
                       "out/%s.png");
    add_name(
        verb, "--batch", "FILE|-", options.render.batch,
        "also render the scenes listed in a file or on stdin, one per line: SCENE or SCENE OUTPUT");
    add_picture_options(verb, options.render);
    add_light_options(verb, options.render.light);
    add_device_options(verb, options.render);
    add_report_options(verb, options.render);
    verb.when_chosen([&options, verb] {
        if (!verb.given("--device")) options.render.device = device_from_environment();
        const std::string left = environment("MIRRORBALL_DEVICES");
        if (!options.worker_link.empty() && !left.empty()) options.render.device = left;
        settle_render(options.render);
        options.verb = Verb::render;
    });
}

}  // namespace rt
