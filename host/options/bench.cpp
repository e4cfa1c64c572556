// SPDX-License-Identifier: Apache-2.0
#include "host/base/error.h"
#include "host/options/lists.h"
#include "host/options/verb_options.h"

namespace rt {

namespace {

void parse_schedules(const std::string& text, BenchOptions& bench) {
    bench.schedules.clear();
    bench.scalar = false;
    for (const std::string& part : split_list(text)) {
        if (part == "scalar") {
            bench.scalar = true;
        } else if (const auto schedule = value_of(schedule_names, part)) {
            bench.schedules.push_back(*schedule);
        } else {
            refuse_choice(part, {"tiles", "buffers", "scalar"});
        }
    }
}

/// Defaults of an ablation: one picture on every device.
void settle_ablation(const CommandLine& verb, BenchOptions& bench) {
    if (!bench.baseline.empty()) usage_error("--ablate cannot be combined with --baseline");
    if (!verb.given("--sizes")) bench.sizes = {{500, 500}};
    if (!verb.given("--aa")) bench.aa = parse_aa_list("grid:2");
    if (!verb.given("--precision")) bench.precisions = {Precision::float32};
}

}  // namespace

void add_bench(const CommandLine& program, Options& options) {
    BenchOptions& bench = options.bench;
    bench.aa = parse_aa_list("none,grid:2");
    const CommandLine verb = program.verb("bench", "benchmark OpenCL devices against pthreads");
    verb.arguments("SCENE", bench.scenes, "scene files (default: the built-in cornell-box)", false);
    verb.value("--sizes", "LIST", bench.sizes, list_of(parse_size),
               "picture sizes in pixels, N or WxH (default: 100,200,300,400,500)");
    verb.value("--aa", "LIST", bench.aa, parse_aa_list, "AA modes (default: none,grid:2)");
    add_device_list(verb, "--devices", bench.devices);
    verb.value("--threads", "N", bench.threads, count_in(1, most_threads),
               "time 'threads' with 1 to N threads (default: all cores)");
    add_precisions(verb, bench.precisions);
    add_light_options(verb, bench.light);
    verb.option("--schedules", "LIST",
                "pthreads schedules: tiles, buffers, scalar (tiles, one ray at a time; with one "
                "thread and with all threads) (default: all)",
                [&](const std::string& text) { parse_schedules(text, bench); });
    add_repeats(verb, bench.repeats, 1);
    verb.value("--baseline", "FILE", bench.baseline,
               "compare with an earlier --json file: exit 1 if a row has become slower");
    verb.value("--max-regress", "P%", bench.max_regress, percent_to(1e6),
               "how much slower a row may become; changes within noise also pass (default: 5%)");
    add_result_files(verb, bench.results);
    verb.flag("--ablate", bench.ablate,
              "measure what leaving out each feature saves, with and without it in alternation "
              "(default: --sizes 500 --aa grid:2 --precision float)");
    verb.flag("-q,--quiet", bench.quiet, quiet_help);
    verb.when_chosen([&options, verb] {
        check_result_files(options.bench.results);
        if (options.bench.ablate) settle_ablation(verb, options.bench);
        options.verb = Verb::bench;
    });
}

}  // namespace rt
