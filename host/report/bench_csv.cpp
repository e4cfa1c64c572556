// SPDX-License-Identifier: Apache-2.0
#include "host/report/bench_csv.h"

#include "host/report/bench.h"
#include "host/report/run_csv.h"

namespace rt {

std::string bench_csv(const BenchResult& result) {
    std::string text = run_csv_header() + "\n";
    for (const auto& row : result.rows) {
        const std::string verdict = to_string(row.verdict);
        for (const RenderStats& run : row.warm_up) {
            text += run_csv_line(run, {row.asked.device, verdict, 0});
        }
        int round = 0;
        for (const RenderStats& run : row.repeats) {
            text += run_csv_line(run, {row.asked.device, verdict, ++round});
        }
    }
    return text;
}

}  // namespace rt
