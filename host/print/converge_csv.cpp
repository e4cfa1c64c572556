// SPDX-License-Identifier: Apache-2.0
#include "host/measure/bench.h"
#include "host/print/print_converge.h"
#include "host/print/print_run.h"

namespace rt {

std::string converge_csv(const ConvergeResult& result) {
    std::string text = run_csv_header() + "\n";
    for (const auto& point : result.points) {
        const std::string verdict = to_string(point.verdict);
        for (const RenderStats& run : point.warm_up) {
            text += run_csv_line(run, {point.asked.device, verdict, 0});
        }
        int round = 0;
        for (const RenderStats& run : point.repeats) {
            text += run_csv_line(run, {point.asked.device, verdict, ++round});
        }
    }
    return text;
}

}  // namespace rt
