// SPDX-License-Identifier: Apache-2.0
#include "host/print/print_converge.h"
#include "host/print/print_run.h"

namespace rt {

std::string converge_csv(const ConvergeResult& result) {
    std::string text = run_csv_header() + "\n";
    for (const auto& point : result.points) text += runs_csv(point, point.asked.device);
    return text;
}

}  // namespace rt
