// SPDX-License-Identifier: Apache-2.0
#include "host/base/console.h"
#include "host/base/error.h"
#include "host/cli/options.h"
#include "host/image/output_file.h"
#include "host/picture/crew.h"
#include "host/print/print_run.h"
#include "host/process/stop_signal.h"
#include "host/stress/judge.h"

namespace rt {

namespace {

/// `mirrorball stress`
struct StressCall : StressOptions {
    bool list = false;     ///< name the cases, run none
    bool verbose = false;  ///< a line per case and renderer
    ResultFiles results;
};

int run_stress(const StressCall& options) {
    const std::vector<StressFamily> families =
        chosen_families(all_stress_families(), options.cases, options.except, options.quick);
    if (options.list) {
        print_result(stress_list(families));
        return 0;
    }
    options.results.check({}, {});
    if (!options.output.empty()) {
        create_output_folder(options.output);
        check_output_path(options.output + "/reference.png");
    }
    RenderCache cache;
    const StressResult result = run_stress_cases(families, options, cache);
    if (!options.results.take_stdout()) print_result(stress_text(result, options.verbose));
    options.results.write("--json", [&] { return result_json("stress", result); });
    if (result.interrupted) return 128 + stop_flag();
    return static_cast<int>(result.passed() ? ExitCode::done : ExitCode::different);
}

}  // namespace

void add_stress(Verb& program, const Invocation&) {
    const auto asked = std::make_shared<StressCall>();
    StressCall& stress = *asked;
    Verb& verb = program.verb(
        "stress", "test numerical stability: extreme cases, each with a pass/fail verdict");
    verb.value("--case", "GLOB,...", stress.cases, list_of(parse_text),
               "families (scale-*) or cases (shift/1e9) to run (default: all)");
    verb.value("--except", "GLOB,...", stress.except, list_of(parse_text),
               "families or cases to leave out");
    add_device_list(verb, "--device", stress.devices);
    verb.flag("--quick", stress.quick, "run only the cases that take under a minute in total");
    verb.flag("--all-features", stress.all_features,
              "compile all features into the kernels: one build for all cases");
    verb.flag("--list", stress.list, "list the cases without running them");
    stress.results.add(verb, "--json", json_start("stress"),
                       "write JSON, to FILE or to stdout instead of the table");
    verb.value("-o,--output", "DIR", stress.output,
               "folder for each case's reference, worst picture and error map");
    verb.flag("-v,--verbose", stress.verbose, "print a line per case and renderer");
    add_build_extras(verb);
    verb.flag("-q,--quiet", stress.quiet, quiet_help);
    verb.measures = true;
    verb.run = [asked, &verb] {
        if (asked->list && (verb.given("--json") || verb.given("-o"))) {
            usage_error("--list cannot be combined with --json or -o");
        }
        return run_stress(*asked);
    };
}

}  // namespace rt
