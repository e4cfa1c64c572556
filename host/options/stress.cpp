// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "host/error.h"
#include "host/opencl/device_spec.h"
#include "host/options/lists.h"
#include "host/options/verb_options.h"

namespace rt {

namespace {

void add_list(const CommandLine& verb, const std::string& option, std::vector<std::string>& list,
              const std::string& help) {
    verb.option(option, "GLOB,...", help,
                [&list, option](const std::string& text) { list = split_list(option, text); });
}

}  // namespace

void add_stress(const CommandLine& program, Options& options) {
    StressOptions& stress = options.stress;
    const CommandLine verb = program.verb(
        "stress", "numerical stability: stiff and extreme cases, each with a pass/fail verdict");
    add_list(verb, "--case", stress.cases,
             "families (scale-*) or cases (shift/1e9) to run (default: all)");
    add_list(verb, "--except", stress.except, "families or cases to leave out");
    verb.option(
        "--device", "SPEC,...",
        "device specs as for render; threads; all (default): threads and every OpenCL device",
        [&](const std::string& text) {
            stress.devices = split_list("--device", text);
            for (const std::string& spec : stress.devices) {
                check_device_list(spec);
            }
        });
    verb.flag("--quick", stress.quick, "run only the cases that take under a minute in total");
    verb.flag("--all-features", stress.all_features,
              "compile all features into the kernels: one build for all cases");
    verb.flag("--list", stress.list, "list the cases without running them");
    add_result_file(verb, "--json", stress.json,
                    "write JSON: to FILE, or to stdout instead of the table");
    add_name(verb, "-o,--output", "DIR", stress.output,
             "folder for each case's reference, worst picture and error map");
    verb.flag("-v,--verbose", stress.verbose, "print a line per case and renderer");
    verb.flag("-q,--quiet", stress.quiet, "no progress on stderr");
    verb.when_chosen([&] {
        if (stress.list && !(stress.json.empty() && stress.output.empty())) {
            throw Error(ExitCode::usage, "--list runs nothing: leave out --json and -o");
        }
        options.verb = Verb::stress;
    });
}

}  // namespace rt
