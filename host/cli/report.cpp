// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <span>
#include <vector>

#include "host/base/error.h"
#include "host/base/files.h"
#include "host/cli/options.h"

namespace rt {

namespace {

/// `mirrorball report`; most is only checked here, and used by Python.
struct ReportOptions {
    std::vector<std::string> scenes;
    std::string output;               ///< the page
    std::string plots;                ///< the folder of its plots as files; empty: none
    std::optional<PictureSize> size;  ///< default: the scene's
    std::vector<std::string> devices{"all"};
    int repeats = 5;      ///< not counting the warm-up
    bool quick = false;   ///< fewer settings and a coarser reference: a preview, not for quoting
    bool stress = false;  ///< include the stress suite
    bool quiet = false;
};

constexpr const char* page_start = "<!DOCTYPE html>";
/// The first that can draw: a person's python3 is often not the system's.
std::string choose_python() {
    for (const std::string python : {"python3", "/usr/bin/python3"}) {
        const std::string test = python + " -c 'import matplotlib' 2>/dev/null";
        if (std::system(test.c_str()) == 0) return python;
    }
    throw Error(ExitCode::device,
                "report: neither python3 in PATH nor /usr/bin/python3 can import matplotlib; run "
                "'apt install python3-matplotlib' or 'python3 -m pip install matplotlib'");
}

/// The folder of the Python package: installed, else that of the sources around the build folder.
std::string package_folder() {
    const std::string folder = beside_program(
        {"../share/mirrorball/python", "../python", "../../python"}, "mirrorball/report.py");
    if (!folder.empty()) return folder;
    throw Error(ExitCode::device, "report: its Python package is not installed next to " +
                                      program_file().string() + "; install mirrorball again");
}

/// `arguments`: of the verb, which Python reads in the same way.
int run_report(const ReportOptions& options, std::span<const std::string> arguments) {
    if (std::ranges::count(options.scenes, stdin_scene) > 0) {
        usage_error(
            "report reads its scenes several times, and stdin can be read once; name a file");
    }
    check_result_path(options.output, page_start);
    std::string path = package_folder();
    ::setenv("PYTHONSAFEPATH", "1", 1);  // no modules from the working folder
    const std::string python = choose_python();
    const std::string own = environment("PYTHONPATH");
    if (!own.empty()) path += ":" + own;
    ::setenv("PYTHONPATH", path.c_str(), 1);
    ::setenv("PYTHONDONTWRITEBYTECODE", "1", 1);
    ::setenv("MIRRORBALL", program_file().c_str(), 1);
    std::vector<std::string> words{python, "-m", "mirrorball.report"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    ::execvp(pointers[0], pointers.data());
    throw Error(ExitCode::device, "report: cannot run " + python);
}

}  // namespace

void add_report(Verb& program, const Invocation& call) {
    const auto asked = std::make_shared<ReportOptions>();
    ReportOptions& report = *asked;
    Verb& verb =
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
    verb.run = [asked, &call] {
        return run_report(*asked, std::span<const std::string>(call.command).subspan(2));
    };
}

}  // namespace rt
