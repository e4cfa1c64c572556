// SPDX-License-Identifier: Apache-2.0
#include "host/measure/converge.h"

#include "host/base/console.h"
#include "host/base/error.h"
#include "host/cli/options.h"
#include "host/image/picture_io.h"
#include "host/opencl/pocl.h"
#include "host/print/print_run.h"

namespace rt {

namespace {

/// `mirrorball converge`
struct ConvergeCall : ConvergeOptions {
    ResultFiles results;
};

int run_converge(const ConvergeCall& options) {
    options.results.check({}, {options.reference});
    if (!options.reference.empty()) {
        const PictureFormat format = picture_format_of_name(options.reference);
        if (format != PictureFormat::exr && format != PictureFormat::pfm) {
            usage_error("--reference {}: rounds colors; name an EXR or PFM file",
                        options.reference);
        }
        check_picture_path(options.reference);
    }
    start_fresh_pocl_cache();
    const ConvergeResult result = measure_converge(options);
    if (!options.results.take_stdout()) print_result(converge_text(result));
    options.results.write("--json", [&] { return result_json("converge", result); });
    options.results.write("--csv", [&] { return converge_csv(result); });
    return report_bad_rows(result.points, result.interrupted, [](const ConvergeCase& asked) {
        return asked.device_name + " " + to_string(asked.picture.aa);
    });
}

constexpr const char* default_sweep =
    "none,grid:2,grid:3,grid:4,grid:6,grid:8,sobol:1,sobol:4,sobol:16,sobol:64,sobol:256,"
    "adaptive:0.1,adaptive:0.03,adaptive:0.01,edges:0.01,edges:0.001,edges:0.0001";

const Named<std::vector<Math>> math_choices[] = {
    {"strict", {Math::strict}}, {"fast", {Math::fast}}, {"both", {Math::strict, Math::fast}}};

void add_sweep(Verb& verb, ConvergeCall& converge) {
    add_size(verb, converge.size);
    verb.value("--aa", "LIST", converge.aa, parse_aa_list,
               "AA modes (default: " + std::string(default_sweep) + ")");
    add_device_list(verb, "--devices", converge.devices);
    verb.value("--threads", "N", converge.threads, count_in(1, DeviceSpec::most_threads),
               "number of threads for 'threads' (default: all cores)");
    add_precisions(verb, converge.precisions);
    add_choice(verb, "--math", converge.math, math_choices,
               "strict (default), fast (OpenCL devices only) or both");
    verb.value("--max-bounces", "LIST", converge.max_bounces, list_of(count_in(0, most_bounces)),
               bounces_help);
}

}  // namespace

void add_converge(Verb& program, const Invocation&) {
    const auto asked = std::make_shared<ConvergeCall>();
    ConvergeCall& converge = *asked;
    converge.aa = parse_aa_list(default_sweep);
    Verb& verb = program.verb("converge", "measure error against run time");
    verb.argument("SCENE", converge.scene, scene_help);
    add_sweep(verb, converge);
    add_light_options(verb, converge.light);
    add_repeats(verb, converge.repeats, 5);
    verb.value("--reference-samples", "N", converge.reference_samples, count_in(2, 4096),
               "the reference is the mean of two sobol:N pictures in double (default: 1024)");
    verb.value("--reference", "FILE", converge.reference,
               "keep the reference in this EXR or PFM file, or read it from there if it exists");
    converge.results.add(verb, "--json", json_start("converge"), "write all measurements as JSON");
    converge.results.add(verb, "--csv", csv_start, "write one row per run as CSV");
    add_build_extras(verb);
    verb.flag("-q,--quiet", converge.quiet, quiet_help);
    verb.run = [asked] { return run_converge(*asked); };
    verb.measures = true;
}

}  // namespace rt
