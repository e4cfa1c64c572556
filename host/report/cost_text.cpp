// SPDX-License-Identifier: Apache-2.0
#include "host/report/cost_text.h"

#include <fmt/format.h>

namespace rt {

namespace {

std::string table_text(const CostTable& table) {
    std::string text =
        fmt::format("{}, {}x{} {}, {}: robust {:.4f} {}, the fastest of {}\n", table.scene,
                    table.width, table.height, table.aa, table.renderer, table.robust_seconds,
                    table.of_processor ? "CPU seconds" : "s", table.repeats);
    text += fmt::format("  {:<12} {:<30} {:>10} {:>13}\n", "naive in", "instead", "seconds",
                        "robust / that");
    for (const TechniqueCost& row : table.rows) {
        text += fmt::format("  {:<12} {:<26} {:>10.4f} {:>13.3f}\n", row.technique, row.naive,
                            row.seconds, table.ratio(row));
    }
    return text;
}

}  // namespace

std::string cost_text(const std::vector<CostTable>& tables) {
    std::string text;
    for (const CostTable& table : tables) text += table_text(table);
    return text + "What each technique is for: docs/numerics.md\n";
}

}  // namespace rt
