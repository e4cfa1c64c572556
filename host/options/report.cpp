// SPDX-License-Identifier: Apache-2.0
#include "host/options/lists.h"
#include "host/options/verb_options.h"

namespace rt {

void add_report(const CommandLine& program, Options& options) {
    ReportOptions& report = options.report;
    const CommandLine verb =
        program.verb("report", "write an HTML page: pictures, timings, error against run time");
    verb.arguments("SCENE", report.scenes, scene_help, true);
    const auto parse_page = [](const std::string& text) {
        if (!text.ends_with(".html")) refuse(text, "expected a file name that ends in .html");
        return text;
    };
    verb.value("-o,--output", "FILE", report.output, parse_page, "HTML file to write", true);
    verb.value("--plots", "DIR", report.plots, "also write each plot as SVG, PDF and PNG into DIR");
    verb.value("--size", "WxH|N", report.size, parse_size,
               "size of the largest picture in pixels (default: the scene's)");
    add_device_list(verb, "--devices", report.devices);
    add_repeats(verb, report.repeats, 5);
    verb.flag("--quick", report.quick,
              "fewer settings and a coarser reference: a preview, not for publication");
    verb.flag("--stress", report.stress,
              "also run the stress suite, which takes minutes (with --quick, its quick part)");
    verb.flag("-q,--quiet", report.quiet, quiet_help);
    verb.when_chosen([&] { options.verb = Verb::report; });
}

}  // namespace rt
