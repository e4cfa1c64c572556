// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <vector>

#include "host/base/error.h"
#include "host/options/report_options.h"
#include "host/print/result_file.h"
#include "host/verbs/verbs.h"

namespace rt {

namespace {

namespace fs = std::filesystem;

constexpr const char* page_start = "<!DOCTYPE html>";
constexpr const char* debian_python = "/usr/bin/python3";

/// The python3 in PATH; empty if there is none.
std::string python_in_path() {
    const char* const value = std::getenv("PATH");
    std::string path = value == nullptr ? "" : value;
    while (!path.empty()) {
        const std::string folder = path.substr(0, path.find(':'));
        path.erase(0, folder.size() + 1);
        const std::string python = folder + "/python3";
        if (!folder.empty() && ::access(python.c_str(), X_OK) == 0) return python;
    }
    return "";
}

bool has_matplotlib(const std::string& python) {
    const std::string test = fmt::format("'{}' -c 'import matplotlib' 2>/dev/null", python);
    return !python.empty() && std::system(test.c_str()) == 0;
}

/// The first that can draw: a person's python3 is often not the system's.
std::string choose_python() {
    const std::string own = python_in_path();
    for (const std::string& python : {own, std::string(debian_python)}) {
        if (has_matplotlib(python)) return python;
    }
    const std::string others =
        own.empty() || own == debian_python ? "" : " and " + std::string(debian_python);
    throw Error(ExitCode::device,
                fmt::format("report: {}{} cannot import matplotlib; run 'apt install "
                            "python3-matplotlib' or 'python3 -m pip install matplotlib'",
                            own.empty() ? debian_python : own, others));
}

/// The folder of the Python package: installed, else that of the sources around the build folder.
std::string package_folder(const fs::path& program) {
    for (const char* place : {"../share/mirrorball/python", "../python", "../../python"}) {
        const fs::path folder = program.parent_path() / place;
        if (fs::exists(folder / "mirrorball/report.py")) return folder.lexically_normal();
    }
    throw Error(ExitCode::device, "report: its Python package is not installed next to " +
                                      program.string() + "; install mirrorball again");
}

std::vector<std::string> command(const std::string& python, const ReportOptions& options) {
    std::vector<std::string> words{python, "-m", "mirrorball.report", "-o", options.output};
    const auto add = [&](std::initializer_list<std::string> more) {
        words.insert(words.end(), more);
    };
    add({fmt::format("--devices={}", fmt::join(options.devices, ",")), "--repeats",
         std::to_string(options.repeats)});
    if (!options.plots.empty()) add({"--plots=" + options.plots});
    if (options.size) {
        add({"--size", fmt::format("{}x{}", options.size->width, options.size->height)});
    }
    if (options.quick) add({"--quick"});
    if (options.stress) add({"--stress"});
    if (options.quiet) add({"--quiet"});
    add({"--"});
    words.insert(words.end(), options.scenes.begin(), options.scenes.end());
    return words;
}

}  // namespace

int run_report(const ReportOptions& options) {
    check_result_path(options.output, page_start);
    const fs::path program = fs::read_symlink("/proc/self/exe");
    std::string path = package_folder(program);
    ::setenv("PYTHONSAFEPATH", "1", 1);  // no modules from the working folder
    const std::string python = choose_python();
    if (const char* const own = std::getenv("PYTHONPATH")) path += ":" + std::string(own);
    ::setenv("PYTHONPATH", path.c_str(), 1);
    ::setenv("PYTHONDONTWRITEBYTECODE", "1", 1);
    ::setenv("MIRRORBALL", program.c_str(), 1);
    std::vector<std::string> words = command(python, options);
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    ::execv(pointers[0], pointers.data());
    throw Error(ExitCode::device, "report: cannot run " + python);
}

}  // namespace rt
