// SPDX-License-Identifier: Apache-2.0
#include "host/options/lists.h"
#include "host/options/verb_options.h"

namespace rt {

namespace {

constexpr const char* default_sweep =
    "none,grid:2,grid:3,grid:4,grid:6,grid:8,sobol:1,sobol:4,sobol:16,sobol:64,sobol:256,"
    "adaptive:0.1,adaptive:0.03,adaptive:0.01";

/// The modes of the default sweep that this program has.
std::vector<AaMode> default_modes() {
    std::vector<AaMode> modes;
    for (const std::string& part : split_list("--aa", default_sweep)) {
        if (const auto mode = parse_aa_mode(part)) modes.push_back(*mode);
    }
    return modes;
}

/// Where references are kept, by the XDG Base Directory specification.
std::string reference_folder() {
    if (const std::string xdg = environment("XDG_CACHE_HOME"); !xdg.empty()) {
        return xdg + "/mirrorball/references";
    }
    const std::string home = environment("HOME");
    return home.empty() ? "" : home + "/.cache/mirrorball/references";
}

std::vector<int> parse_bounces(const std::string& text) {
    std::vector<int> bounces;
    for (const std::string& part : split_list("--max-bounces", text)) {
        bounces.push_back(parse_count("--max-bounces", part, 0, 100000));
    }
    return bounces;
}

void add_sweep(const CommandLine& verb, ConvergeOptions& converge) {
    verb.option("--size", "WxH|N", "pixels (default: the scene's)",
                [&](const std::string& text) { converge.size = parse_size("--size", text); });
    verb.option("--aa", "LIST", "AA modes (default " + std::string(default_sweep) + ")",
                [&](const std::string& text) { converge.aa = parse_aa_list("--aa", text); });
    add_device_list(verb, converge.devices);
    add_count(verb, "--threads", converge.threads, 1, 4096,
              "number of threads for 'threads' (default: all cores)");
    verb.flag("--scalar", converge.scalar,
              "also time threads that trace one ray at a time, without vectors (float)");
    add_precisions(verb, converge.precisions);
    add_choice<std::vector<bool>>(verb, "--math", converge.fast_math,
                                  {{"strict", {false}}, {"fast", {true}}, {"both", {false, true}}},
                                  "strict (default), fast (OpenCL devices only) or both");
    verb.option("--max-bounces", "LIST",
                "mirror and refracted rays after the eye ray (default: the scene's)",
                [&](const std::string& text) { converge.max_bounces = parse_bounces(text); });
}

}  // namespace

void add_converge(const CommandLine& program, Options& options) {
    ConvergeOptions& converge = options.converge;
    converge.aa = default_modes();
    converge.cache_folder = reference_folder();
    const CommandLine verb = program.verb("converge", "error against run time");
    verb.argument("SCENE", converge.scene, "scene file (.json, .nff, .obj, .ply)");
    add_sweep(verb, converge);
    add_light_options(verb, converge.light);
    add_count(verb, "--repeats", converge.repeats, 5, 1000,
              "timed rounds after the warm-up, at least 5 (default 5)");
    add_count(verb, "--reference-samples", converge.reference_samples, 2, 4096,
              "the reference is the mean of two sobol:N pictures in double (default 1024)");
    add_result_files(verb, converge.results);
    verb.flag("-q,--quiet", converge.quiet, "no progress on stderr");
    verb.when_chosen([&] {
        check_result_files(options.converge.results);
        options.verb = Verb::converge;
    });
}

}  // namespace rt
