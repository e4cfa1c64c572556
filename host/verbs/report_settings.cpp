// SPDX-License-Identifier: Apache-2.0
#include "host/verbs/report_settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/options/lists.h"

namespace rt {

namespace {

constexpr const char* full_sweep =
    "none,grid:2,grid:4,sobol:4,sobol:16,sobol:64,sobol:256,adaptive:0.1,adaptive:0.03";
constexpr const char* quick_sweep = "none,grid:2,grid:3,sobol:4";
constexpr int full_reference = 1024, quick_reference = 32;

/// A word, quoted for a POSIX shell.
std::string shell_word(const std::string& word) {
    const auto is_plain = [](unsigned char c) {
        return std::isalnum(c) != 0 || std::string_view("-_./:,=+%@").find(c) != std::string::npos;
    };
    if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
    return quoted + "'";
}

/// The device list, as a word for a shell.
std::string devices_word(const ReportOptions& options) {
    return shell_word(fmt::format("{}", fmt::join(options.devices, ",")));
}

std::string size_text(const ReportOptions& options) {
    return options.size ? fmt::format(" --size {}x{}", options.size->width, options.size->height)
                        : "";
}

}  // namespace

BenchOptions bench_settings(const ReportOptions& options, const std::string& path,
                            const Scene& scene) {
    BenchOptions bench;
    bench.scenes = {path};
    bench.sizes.clear();
    for (const int fifths : options.quick ? std::vector{2, 5} : std::vector{1, 2, 3, 4, 5}) {
        bench.sizes.push_back(
            {std::max(1, scene.width * fifths / 5), std::max(1, scene.height * fifths / 5)});
    }
    bench.aa = {grid_aa(1), scene.aa};
    bench.devices = options.devices;
    bench.precisions = {Precision::float32};
    bench.repeats = options.repeats;
    bench.quiet = options.quiet;
    return bench;
}

ConvergeOptions converge_settings(const ReportOptions& options, const std::string& path,
                                  const Scene& scene) {
    ConvergeOptions converge;
    converge.scene = path;
    converge.size = PictureSize{scene.width, scene.height};
    converge.aa = parse_aa_list(options.quick ? quick_sweep : full_sweep);
    converge.devices = options.devices;
    converge.repeats = options.repeats;
    converge.reference_samples = options.quick ? quick_reference : full_reference;
    converge.cache_folder = options.cache_folder;
    converge.quiet = options.quiet;
    return converge;
}

std::vector<std::string> report_commands(const ReportOptions& options) {
    std::string scenes;
    for (const std::string& scene : options.scenes) scenes += " " + shell_word(scene);
    const std::string rest =
        fmt::format(" --devices {} --repeats {}", devices_word(options), options.repeats);
    const char* const quick = options.quick ? " --quick" : "";
    std::vector<std::string> commands{fmt::format("mirrorball report{} -o {}{}{}{}{}", scenes,
                                                  shell_word(options.output), size_text(options),
                                                  rest, quick, options.stress ? " --stress" : "")};
    for (const std::string& path : options.scenes) {
        const std::string scene = shell_word(path);
        commands.push_back(fmt::format("mirrorball render {}{} --aa none -o plain.png --stats",
                                       scene, size_text(options)));
        commands.push_back(
            fmt::format("mirrorball render {}{} -o smooth.png --stats", scene, size_text(options)));
        commands.push_back(fmt::format("mirrorball render {}{} --features all --stats", scene,
                                       size_text(options)));
        commands.push_back(
            fmt::format("mirrorball bench {} --precision float --json -{}", scene, rest));
        commands.push_back(
            fmt::format("mirrorball converge {}{} --aa {} --reference-samples {}{} --json -", scene,
                        size_text(options), options.quick ? quick_sweep : full_sweep,
                        options.quick ? quick_reference : full_reference, rest));
    }
    if (options.stress) {
        commands.push_back(
            fmt::format("mirrorball stress --device {}{} --json -", devices_word(options), quick));
    }
    return commands;
}

}  // namespace rt
