// SPDX-License-Identifier: Apache-2.0
#include "host/base/error.h"
#include "host/options/lists.h"
#include "host/options/verb_options.h"

namespace rt {

void add_stress(const CommandLine& program, Options& options) {
    StressOptions& stress = options.stress;
    const CommandLine verb = program.verb(
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
    add_result_file(verb, "--json", stress.json,
                    "write JSON, to FILE or to stdout instead of the table");
    verb.value("-o,--output", "DIR", stress.output,
               "folder for each case's reference, worst picture and error map");
    verb.flag("-v,--verbose", stress.verbose, "print a line per case and renderer");
    verb.flag("-q,--quiet", stress.quiet, quiet_help);
    verb.when_chosen([&] {
        if (stress.list && !(stress.json.empty() && stress.output.empty())) {
            usage_error("--list cannot be combined with --json or -o");
        }
        options.verb = Verb::stress;
    });
}

}  // namespace rt
