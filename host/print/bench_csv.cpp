// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench.h"
#include "host/print/print_bench.h"
#include "host/print/print_run.h"

namespace rt {

namespace {

std::string row_csv(const BenchRow& row) {
    const std::string verdict = to_string(row.verdict);
    std::string device = row.asked.device;
    if (!row.asked.change.empty()) device += " " + row.asked.change;
    std::string text;
    for (const RenderStats& run : row.warm_up) text += run_csv_line(run, {device, verdict, 0});
    int round = 0;
    for (const RenderStats& run : row.repeats) {
        text += run_csv_line(run, {device, verdict, ++round});
    }
    return text;
}

}  // namespace

std::string bench_csv(const BenchResult& result) {
    std::string text = run_csv_header() + "\n";
    for (const auto* rows : {&result.rows, &result.ablation}) {
        for (const BenchRow& row : *rows) text += row_csv(row);
    }
    return text;
}

}  // namespace rt
