// SPDX-License-Identifier: Apache-2.0
#include "host/error.h"
#include "host/options/lists.h"
#include "host/options/verb_options.h"

namespace rt {

void add_report(CLI::App& app, Options& options) {
    ReportOptions& report = options.report;
    CLI::App& verb =
        *app.add_subcommand("report", "one page: pictures, timings, error against run time");
    verb.add_option("SCENE", report.scenes, "scene files (.json, .nff, .obj, .ply)")->required();
    verb.add_option_function<std::string>(
            "-o,--output",
            [&](const std::string& text) {
                if (!text.ends_with(".html")) refuse("-o", text, "name a file that ends in .html");
                report.output = text;
            },
            "the page (.html)")
        ->type_name("FILE")
        ->required();
    add_text(verb, "--size", "WxH|N", "pixels of the largest picture (default: the scene's)",
             [&](const std::string& text) { report.size = parse_size("--size", text); });
    add_device_list(verb, report.devices);
    add_count(verb, "--repeats", report.repeats, 5, 1000,
              "timed rounds after the warm-up, at least 5 (default 5)");
    verb.add_flag("--quick", report.quick,
                  "fewer settings and a coarser reference: to see the page, not to quote it");
    verb.add_flag("--stress", report.stress,
                  "also the stress suite, minutes more (with --quick: its quick part)");
    verb.add_flag("-q,--quiet", report.quiet, "no progress on stderr");
    verb.callback([&] {
        options.report.cache_folder = options.converge.cache_folder;
        options.verb = Verb::report;
    });
}

}  // namespace rt
