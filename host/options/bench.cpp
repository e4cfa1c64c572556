// SPDX-License-Identifier: Apache-2.0
#include <charconv>

#include "host/error.h"
#include "host/options/lists.h"
#include "host/options/verb_options.h"

namespace rt {

namespace {

std::vector<PictureSize> parse_sizes(const std::string& text) {
    std::vector<PictureSize> sizes;
    for (const std::string& part : split_list("--sizes", text)) {
        sizes.push_back(parse_size("--sizes", part));
    }
    return sizes;
}

void parse_schedules(const std::string& text, BenchOptions& bench) {
    bench.schedules.clear();
    bench.scalar = false;
    for (const std::string& part : split_list("--schedules", text)) {
        if (part == "scalar") {
            bench.scalar = true;
            continue;
        }
        if (part != "tiles" && part != "buffers") {
            refuse_choice("--schedules", part, {"tiles", "buffers", "scalar"});
        }
        bench.schedules.push_back(part == "tiles" ? Schedule::tiles : Schedule::buffers);
    }
}

void add_baseline(const CommandLine& verb, BenchOptions& bench) {
    add_name(verb, "--baseline", "FILE", bench.baseline,
             "an earlier --json file: exit 1 if a row has become slower");
    verb.option("--max-regress", "P%",
                "how much slower a row may become (default 5%); changes within noise also pass",
                [&](const std::string& text) {
                    bench.max_regress = parse_percent("--max-regress", text, 1e6);
                });
}

/// Defaults of an ablation: one picture on every device.
void settle_ablation(const CommandLine& verb, BenchOptions& bench) {
    if (!bench.baseline.empty()) {
        throw Error(ExitCode::usage, "give --ablate or --baseline, not both");
    }
    if (!verb.given("--sizes")) bench.sizes = {{500, 500}};
    if (!verb.given("--aa")) bench.aa = parse_aa_list("--aa", "grid:2");
    if (!verb.given("--precision")) bench.precisions = {Precision::float32};
}

}  // namespace

void add_bench(const CommandLine& program, Options& options) {
    BenchOptions& bench = options.bench;
    bench.aa = parse_aa_list("--aa", "none,grid:2");
    const CommandLine verb = program.verb("bench", "time OpenCL devices against pthreads");
    verb.arguments("SCENE", bench.scenes, "scene files (default: the built-in cornell-box)", false);
    verb.option("--sizes", "LIST", "pixels, N or WxH (default 100,200,300,400,500)",
                [&](const std::string& text) { bench.sizes = parse_sizes(text); });
    verb.option("--aa", "LIST", "AA modes (default none,grid:2)",
                [&](const std::string& text) { bench.aa = parse_aa_list("--aa", text); });
    add_device_list(verb, bench.devices);
    add_count(verb, "--threads", bench.threads, 1, 4096,
              "time 'threads' with 1 to N threads (default: all cores)");
    add_precisions(verb, bench.precisions);
    add_light_options(verb, bench.light);
    verb.option(
        "--schedules", "LIST",
        "schedules for pthreads: tiles, buffers, scalar (tiles, one ray at a time; with one "
        "thread and with all threads); default: all",
        [&](const std::string& text) { parse_schedules(text, bench); });
    add_count(verb, "--repeats", bench.repeats, 1, 1000,
              "timed rounds after the warm-up (default 5)");
    add_baseline(verb, bench);
    add_result_files(verb, bench.results);
    verb.flag("--ablate", bench.ablate,
              "measure what each omission saves: each off and on, interleaved (default "
              "--sizes 500 --aa grid:2 --precision float)");
    verb.flag("-q,--quiet", bench.quiet, "no progress on stderr");
    verb.when_chosen([&options, verb] {
        check_result_files(options.bench.results);
        if (options.bench.ablate) settle_ablation(verb, options.bench);
        options.verb = Verb::bench;
    });
}

}  // namespace rt
