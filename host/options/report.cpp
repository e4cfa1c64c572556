// SPDX-License-Identifier: Apache-2.0
#include "host/error.h"
#include "host/options/lists.h"
#include "host/options/verb_options.h"

namespace rt {

void add_report(const CommandLine& program, Options& options) {
    ReportOptions& report = options.report;
    const CommandLine verb =
        program.verb("report", "write one page: pictures, timings, error against run time");
    verb.arguments("SCENE", report.scenes, "scene files (.json, .nff, .obj, .ply)", true);
    verb.option(
        "-o,--output", "FILE", "page to write (.html)",
        [&](const std::string& text) {
            if (!text.ends_with(".html")) refuse("-o", text, "name a file that ends in .html");
            report.output = text;
        },
        true);
    verb.option("--size", "WxH|N", "pixels of the largest picture (default: the scene's)",
                [&](const std::string& text) { report.size = parse_size("--size", text); });
    add_device_list(verb, report.devices);
    add_count(verb, "--repeats", report.repeats, 5, 1000,
              "timed rounds after the warm-up, at least 5 (default 5)");
    verb.flag("--quick", report.quick,
              "fewer settings and a coarser reference: for a preview, not for figures to quote");
    verb.flag("--stress", report.stress,
              "also run the stress suite, which takes minutes (with --quick: its quick part)");
    verb.flag("-q,--quiet", report.quiet, "no progress on stderr");
    verb.when_chosen([&] {
        options.report.cache_folder = options.converge.cache_folder;
        options.verb = Verb::report;
    });
}

}  // namespace rt
