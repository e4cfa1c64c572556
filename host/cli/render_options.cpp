// SPDX-License-Identifier: Apache-2.0
#include "host/cli/render_options.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "host/base/text.h"
#include "host/cli/options.h"
#include "host/image/output_file.h"
#include "host/opencl/devices.h"
#include "host/render/native_kernels.h"

namespace rt {

namespace {

/// "HOST:PORT", or "HOST" at tev's port.
TevAddress parse_tev_address(const std::string& text) {
    TevAddress address;
    const std::size_t colon = text.rfind(':');
    address.host = text.substr(0, colon);
    if (colon != std::string::npos) address.port = text.substr(colon + 1);
    return address;
}

void add_view_options(Verb& verb, ViewSettings& view) {
    view.terminal = environment("TERM");
    view.without_colors = !environment("NO_COLOR").empty();
    verb.flag("--preview", view.preview, "show the picture in the terminal while it renders");
    verb.flag("--show", view.window,
              "show the picture in a window while it renders; Escape or q closes the window, and "
              "the command ends when it is closed");
    const TevAddress usual;
    verb.optional_value(
        "--tev", "=HOST[:PORT]",
        "show the picture in the image viewer tev while it renders (default: 127.0.0.1:14158)",
        usual.host + ":" + usual.port, [](const std::string&) { return false; },
        [&view](const std::string& text) { view.tev = parse_tev_address(text); });
}

constexpr Named<Launch> launches[] = {{"pixel", Launch::pixel}, {"sample", Launch::sample}};
constexpr Named<int> lane_counts[] = {{"auto", 0}, {"1", 1}, {"2", 2},
                                      {"4", 4},    {"8", 8}, {"16", 16}};
constexpr Named<std::optional<bool>> hierarchy_choices[] = {
    {"auto", std::nullopt}, {"on", true}, {"off", false}};
constexpr Named<bool> switch_choices[] = {{"on", true}, {"off", false}};
constexpr Named<bool> isolate_choices[] = {{"auto", true}, {"never", false}};
constexpr Named<StatsFormat> stats_formats[] = {{"text", StatsFormat::text},
                                                {"json", StatsFormat::json}};
constexpr Named<ProgressMode> progress_modes[] = {{"auto", ProgressMode::automatic},
                                                  {"bar", ProgressMode::bar},
                                                  {"plain", ProgressMode::plain},
                                                  {"json", ProgressMode::json},
                                                  {"none", ProgressMode::none}};

/// x0,y0,x1,y1 in pixels from the top left; x1 and y1 are exclusive.
Rect parse_crop(const std::string& text) {
    const auto n = parse_integers(text, ',');
    if (!n || n->size() != 4 || (*n)[0] < 0 || (*n)[1] < 0 || (*n)[2] <= (*n)[0] ||
        (*n)[3] <= (*n)[1]) {
        refuse(text, "expected x0,y0,x1,y1 in pixels from the top left, with x0<x1 and y0<y1");
    }
    return {(*n)[0], (*n)[1], (*n)[2] - (*n)[0], (*n)[3] - (*n)[1]};
}

Shares parse_shard(const std::string& text) {
    const auto shares = parse_shares(text);
    if (!shares) refuse(text, "expected shares from 0 to N-1, and N, such as 7/64 or 7,9,20-25/64");
    return *shares;
}

std::vector<int> parse_frames(const std::string& text) {
    const auto frames = parse_ranges(text, last_frame);
    if (!frames) refuse(text, "expected frames from 0 to 999999, such as 1-240 or 1,5,10-20");
    return *frames;
}

std::string parse_isa(const std::string& text) {
    const std::vector<std::string> isas = native_isas();
    if (text == "auto") return "";
    if (std::ranges::count(isas, text) == 0) refuse_choice(text, isas);
    return text;
}

std::uint64_t parse_hash(const std::string& text) {
    if (text.size() != 16 || text.find_first_not_of("0123456789abcdefABCDEF") != text.npos) {
        refuse(text, "expected 16 hexadecimal digits, as render prints them");
    }
    return std::stoull(text, nullptr, 16);
}

/// "all", "auto", or names as in --stats with hyphens for blanks.
void parse_features(const std::string& text, RenderOptions& render) {
    render.kernels.features = text == "all" ? every_feature : Features();
    if (text == "all" || text == "auto") return;
    std::vector<std::string> names;
    for (const char* feature : feature_names) {
        std::string& name = names.emplace_back(feature);
        std::replace(name.begin(), name.end(), ' ', '-');
    }
    for (const std::string& part : split_list(text)) {
        const auto found = std::find(names.begin(), names.end(), part);
        if (found == names.end()) {
            if (part == text) names.insert(names.begin(), {"auto", "all"});
            refuse_choice(part, names);
        }
        render.kernels.features.set(static_cast<std::size_t>(found - names.begin()));
    }
}

void add_picture_options(Verb& verb, RenderOptions& render) {
    add_size(verb, render.size);
    verb.value("--aa", "MODE", render.aa, parse_aa,
               std::string("samples per pixel: ") + aa_mode_help + " (default: the scene's)");
    add_choice(verb, "--filter", render.filter, filter_names,
               "reconstruction filter (default: box)");
    verb.value("--crop", "x0,y0,x1,y1", render.crop, parse_crop,
               "render only this window, in pixels from the top left, excluding x1 and y1");
    verb.value("--max-bounces", "N", render.max_bounces, count_in(0, most_bounces), bounces_help);
    add_encoding(verb, render.encoding);
    verb.value("--reference", "FILE", render.reference,
               "also print the error relative to this picture");
    verb.flag(
        "--estimate", render.estimate,
        "also estimate the picture's RMSE, without a reference, from some pixels traced again");
    verb.value("--target-rmse", "E", render.target_rmse,
               number_in(1e-5, 1.0, "an RMSE from 1e-5 to 1"),
               "as many samples as it takes for an estimated RMSE of at most E, starting with --aa "
               "(default: edges:E; with another --filter than box sobol:4, or sobol:16 with "
               "mitchell); implies --estimate");
    verb.value("--expect", "HASH", render.expected_hash, parse_hash,
               "exit 1 if the picture has another hash");
}

void add_series_options(Verb& verb, RenderOptions& render) {
    verb.value("--batch", "FILE|-", render.batch,
               "also render the scenes listed in a file or on stdin, one per line: SCENE or SCENE "
               "OUTPUT");
    verb.value("--shard", "I/N", render.shares, parse_shard,
               "render only some of N shares (7/64 or 7,9,20-25/64, counted from 0) into a part "
               "file, -o FILE.mbj, for 'mirrorball merge'");
    verb.value("--frames", "LIST", render.frames, parse_frames,
               "render frames of the scene's camera path (1-240 or 1,5,10-20), each to its own "
               "picture, -o out.%04d.png; with --shard I/N only every Nth frame, with --resume "
               "only the missing ones");
    verb.value("--timeout", "S", render.timeout, seconds_from(0.001),
               "stop after S seconds and save the finished part");
    verb.flag("--watch", render.watch,
              "render again whenever the scene file or one of its models changes, until Ctrl-C "
              "or, with --show, until the window is closed");
    verb.flag(
        "--fresh", render.fresh,
        "start over, ignoring what an interrupted render left in FILE.mbj next to the output");
    verb.flag("--resume", render.resume,
              "save finished tiles in FILE.mbj from the start, not only after 2 s");
}

void add_device_options(Verb& verb, RenderOptions& render) {
    verb.value(
        "--device", "SPEC", render.device, parse_device,
        "index, platform:device, pocl, name:TEXT, cpu, gpu, threads[:N], all or auto; several, "
        "separated by commas, share the picture (default: $MIRRORBALL_DEVICE, $CL_PLATFORM_INDEX "
        "and $CL_DEVICE_INDEX, $CL_PLATFORM_NAME or $CL_DEVICE_TYPE, else the best available)");
    add_choice(verb, "--precision", render.precision, precision_names,
               "arithmetic precision (default: float)");
    add_choice(verb, "--math", render.math, math_names,
               "strict (default): the same bits everywhere; fast: the compiler may contract "
               "operations");
    add_choice(verb, "--launch", render.kernels.launch, launches,
               "what each OpenCL work item renders (default: pixel on CPUs, sample elsewhere)");
    add_choice(verb, "--lanes", render.kernels.lanes, lane_counts,
               "rays per packet (default: a CPU's vector width; 1 on GPUs)");
    verb.value("--isa", "NAME", render.kernels.isa, parse_isa,
               "instruction set of the pthreads kernels, as listed by 'mirrorball devices' "
               "(default: the best)");
    add_choice(verb, "--schedule", render.schedule, schedule_names,
               "pthreads: shared tiles (default), or one thread per sample buffer");
    verb.value("--threads", "N", render.threads, count_in(1, DeviceSpec::most_threads),
               "number of threads for pthreads and PoCL (default: all cores)");
    verb.value("--tile", "WxH|N", render.tile, parse_size,
               "tile size in pixels (default: chosen by the device)");
    verb.option(
        "--features", "auto|all|LIST",
        "compile what the scene needs (default), everything, or what it needs plus LIST (as "
        "--stats names them, with hyphens for blanks)",
        [&](const std::string& text) { parse_features(text, render); });
    add_choice(verb, "--hierarchies", render.hierarchies, hierarchy_choices,
               "build bounding volume hierarchies (default: auto, where they are faster)");
    add_choice(verb, "--caster-lists", render.caster_lists, switch_choices,
               "list the triangles that can cast shadows, if there are few (default: on)");
    add_choice(verb, "--isolate", render.isolate, isolate_choices,
               "auto (default): load OpenCL drivers in a separate process; never: in this one");
    verb.value("--deadline", "S", render.deadline, seconds_from(0.1),
               "seconds without progress after which a driver counts as hung (default: 10)");
    add_build_extras(verb);
    verb.flag("--no-fallback", render.no_fallback,
              "fail if the device fails, instead of finishing on threads");
    verb.value("--check", "P%", render.check, percent_to(100),
               "trace P% of the tiles from a device or journal again on threads and compare");
}

void add_report_options(Verb& verb, RenderOptions& render) {
    verb.optional_value(
        "--stats", fmt::format("{}", fmt::join(names_of(stats_formats), "|")),
        "print phases, rays, and features used and left out to stdout", "text",
        [](const std::string& text) { return value_of(stats_formats, text).has_value(); },
        [&](const std::string& text) { render.stats = one_of(stats_formats)(text); });
    add_choice(verb, "--progress", render.progress, progress_modes,
               "progress on stderr (default: auto, a bar on a terminal, else lines)");
    verb.value("--aov", "LIST", render.aovs, set_of(one_of(aov_names)),
               "also save per-pixel data (depth, normal, id, rays, samples): next to an .exr "
               "picture as channels of NAME.aov.exr, otherwise as false-color pictures "
               "NAME.depth.png, ...");
    verb.flag("-q,--quiet", render.quiet, "print only errors");
    verb.flag("-v,--verbose", render.verbose, "print more");
}

}  // namespace

void add_render(Verb& program, const Invocation& call) {
    const auto asked = std::make_shared<RenderOptions>();
    RenderOptions& render = *asked;
    Verb& verb = program.verb("render", "render one or more pictures");
    verb.arguments("SCENE", render.scenes,
                   "scene files (.json, .nff, .obj, .ply), or - for JSON from standard input",
                   false);
    verb.group = "Picture";
    add_picture_output(
        verb, render.output, render.format,
        "picture file: .png, .exr, .pfm, .tif, .jpg, ..., or - for standard output "
        "(default: none); for several scenes, %s stands for the scene file's name, as in "
        "out/%s.png");
    add_picture_options(verb, render);
    add_light_options(verb, render.light);
    verb.group = "Several pictures, and parts of one";
    add_series_options(verb, render);
    verb.group = "Devices";
    add_device_options(verb, render);
    verb.group = "Messages and figures";
    add_report_options(verb, render);
    verb.group = "Watching";
    add_view_options(verb, render.view);
    verb.run = [asked, &verb, &call] {
        if (!verb.given("--device")) asked->device = device_from_environment();
        settle_render(*asked);
        return run_render(*asked, call);
    };
}

}  // namespace rt
