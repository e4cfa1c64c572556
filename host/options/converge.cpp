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
    for (const std::string& part : split_list(default_sweep)) {
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

const Named<std::vector<Math>> math_choices[] = {
    {"strict", {Math::strict}}, {"fast", {Math::fast}}, {"both", {Math::strict, Math::fast}}};

void add_sweep(const CommandLine& verb, ConvergeOptions& converge) {
    add_size(verb, converge.size);
    verb.value("--aa", "LIST", converge.aa, parse_aa_list,
               "AA modes (default: " + std::string(default_sweep) + ")");
    add_device_list(verb, "--devices", converge.devices);
    verb.value("--threads", "N", converge.threads, count_in(1, most_threads),
               "number of threads for 'threads' (default: all cores)");
    verb.flag("--scalar", converge.scalar,
              "also time pthreads tracing one ray at a time, without vectors (float)");
    add_precisions(verb, converge.precisions);
    add_choice(verb, "--math", converge.math, math_choices,
               "strict (default), fast (OpenCL devices only) or both");
    verb.value("--max-bounces", "LIST", converge.max_bounces, list_of(count_in(0, most_bounces)),
               bounces_help);
}

}  // namespace

void add_converge(const CommandLine& program, Options& options) {
    ConvergeOptions& converge = options.converge;
    converge.aa = default_modes();
    converge.cache_folder = reference_folder();
    const CommandLine verb = program.verb("converge", "measure error against run time");
    verb.argument("SCENE", converge.scene, scene_help);
    add_sweep(verb, converge);
    add_light_options(verb, converge.light);
    add_repeats(verb, converge.repeats, 5);
    verb.value("--reference-samples", "N", converge.reference_samples, count_in(2, 4096),
               "the reference is the mean of two sobol:N pictures in double (default: 1024)");
    add_result_files(verb, converge.results);
    verb.flag("-q,--quiet", converge.quiet, quiet_help);
    verb.when_chosen([&] {
        check_result_files(options.converge.results);
        options.verb = Verb::converge;
    });
}

}  // namespace rt
