// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "host/options/lists.h"
#include "host/options/verb_options.h"
#include "host/render/device_spec.h"
#include "host/render/techniques.h"

namespace rt {

namespace {

void add_list(CLI::App& app, const std::string& option, std::vector<std::string>& list,
              const std::string& help) {
    add_text(app, option, "GLOB,...", help,
             [&list, option](const std::string& text) { list = split_list(option, text); });
}

}  // namespace

void add_stress(CLI::App& app, Options& options) {
    StressOptions& stress = options.stress;
    CLI::App& verb = *app.add_subcommand(
        "stress", "numerical stability: stiff and extreme cases, a verdict each");
    add_list(verb, "--case", stress.cases,
             "families (scale-*) or cases (shift/1e9) to run (default: all)");
    add_list(verb, "--except", stress.except, "families or cases to leave out");
    add_text(verb, "--device", "SPEC,...",
             "as for render; threads; all (default): threads and every OpenCL device",
             [&](const std::string& text) {
                 stress.devices = split_list("--device", text);
                 for (const std::string& spec : stress.devices) {
                     if (spec != "all") check_device_spec(spec);
                 }
             });
    verb.add_flag("--quick", stress.quick, "the cases that take under a minute in all");
    verb.add_flag("--all-features", stress.all_features,
                  "compile all features into the kernels: one build for all cases");
    verb.add_flag("--naive", stress.naive,
                  "also textbook formulas, for comparison, and what robustness costs");
    verb.add_option_function<std::string>(
            "--cost",
            [&](const std::string& text) {
                stress.cost = true;
                stress.cost_scene = text;
            },
            "instead of the cases: what each robust technique costs, timed in turn with the "
            "textbook's on scenes/cornell-box.json and SCENE")
        ->expected(0, 1)
        ->type_name("[SCENE]");
    add_count(verb, "--repeats", stress.repeats, 1, 1000, "pictures timed of each with --cost");
    add_text(verb, "--without", "TECHNIQUE,...",
             "run the cases on OpenCL devices with textbook formulas in place of " +
                 fmt::format("{}", fmt::join(names_of(all_techniques()), ", ")),
             [&](const std::string& text) {
                 stress.without = techniques_named("--without", split_list("--without", text));
             });
    verb.add_flag("--list", stress.list, "name the cases, run none");
    verb.add_option_function<std::string>(
            "--json", [&](const std::string& text) { stress.json = text.empty() ? "-" : text; },
            "as JSON: to FILE, or instead of the table on stdout")
        ->expected(0, 1)
        ->type_name("[FILE|-]");
    verb.add_option("-o,--output", stress.output,
                    "folder for each case's reference, worst picture and error map")
        ->type_name("DIR");
    verb.add_flag("-v,--verbose", stress.verbose, "a line per case and renderer");
    verb.add_flag("-q,--quiet", stress.quiet, "no progress on stderr");
    verb.callback([&] { options.verb = Verb::stress; });
}

}  // namespace rt
