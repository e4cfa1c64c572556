// SPDX-License-Identifier: Apache-2.0
#include "host/print/print_bench.h"
#include "host/print/print_run.h"

namespace rt {

std::string bench_csv(const BenchResult& result) {
    std::string text = run_csv_header() + "\n";
    for (const auto* rows : {&result.rows, &result.ablation}) {
        for (const BenchRow& row : *rows) {
            const std::string& change = row.asked.change;
            text += runs_csv(row, row.asked.device + (change.empty() ? "" : " " + change));
        }
    }
    return text;
}

}  // namespace rt
