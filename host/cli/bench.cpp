// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench.h"

#include <fmt/format.h>

#include "host/base/console.h"
#include "host/cli/options.h"
#include "host/opencl/pocl.h"
#include "host/print/print_run.h"

namespace rt {

namespace {

/// `mirrorball bench`
struct BenchCall : BenchOptions {
    ResultFiles results;
};

int run_bench(const BenchCall& options) {
    options.results.check({}, {});
    start_fresh_pocl_cache();
    const BenchResult result = measure_bench(options);
    if (!options.results.take_stdout()) print_result(bench_text(result));
    options.results.write("--json", [&] { return result_json("bench", result); });
    options.results.write("--csv", [&] { return bench_csv(result); });
    return report_bad_rows(result.rows, result.interrupted, [](const BenchCase& asked) {
        return fmt::format("{} ({})", key_of(asked), asked.device_name);
    });
}

}  // namespace

void add_bench(Verb& program, const Invocation&) {
    const auto asked = std::make_shared<BenchCall>();
    BenchCall& bench = *asked;
    bench.aa = parse_aa_list("none,grid:2");
    for (const auto& way : threads_ways) bench.ways.push_back(way.value);
    Verb& verb = program.verb("bench", "benchmark OpenCL devices against pthreads");
    verb.arguments("SCENE", bench.scenes, "scene files (default: the built-in cornell-box)", false);
    verb.value("--sizes", "LIST", bench.sizes, list_of(parse_size),
               "picture sizes in pixels, N or WxH (default: 100,200,300,400,500)");
    verb.value("--aa", "LIST", bench.aa, parse_aa_list, "AA modes (default: none,grid:2)");
    add_device_list(verb, "--devices", bench.devices);
    verb.value("--threads", "N", bench.threads, count_in(1, DeviceSpec::most_threads),
               "time 'threads' with 1 to N threads (default: all cores)");
    add_precisions(verb, bench.precisions);
    add_light_options(verb, bench.light);
    verb.value("--schedules", "LIST", bench.ways, set_of(one_of(threads_ways)),
               "pthreads schedules: tiles, buffers, scalar (tiles, one ray at a time; with one "
               "thread and with all threads) (default: all)");
    add_repeats(verb, bench.repeats, 1);
    bench.results.add(verb, "--json", json_start("bench"), "write all measurements as JSON");
    bench.results.add(verb, "--csv", csv_start, "write one row per run as CSV");
    add_build_extras(verb);
    verb.flag("-q,--quiet", bench.quiet, quiet_help);
    verb.run = [asked] { return run_bench(*asked); };
    verb.measures = true;
}

}  // namespace rt
