// SPDX-License-Identifier: Apache-2.0
#include "host/stress/stress_result.h"

#include <algorithm>

namespace rt {

bool StressCaseResult::passed() const {
    return disagreement.empty() && !rows.empty() &&
           std::all_of(rows.begin(), rows.end(), [](const StressRow& row) { return row.passed(); });
}

bool StressFamilyResult::passed() const {
    return !cases.empty() && std::all_of(cases.begin(), cases.end(),
                                         [](const StressCaseResult& one) { return one.passed(); });
}

bool StressResult::passed() const {
    return !families.empty() && !interrupted &&
           std::all_of(families.begin(), families.end(),
                       [](const StressFamilyResult& family) { return family.passed(); });
}

PictureFigures worst_figures(const StressFamilyResult& family) {
    PictureFigures worst;
    for (const StressCaseResult& one : family.cases) {
        for (const StressRow& row : one.rows) {
            if (!row.judged) continue;
            const std::size_t failures = row.rays ? row.rays->failures : row.figures.wrong;
            const double error = row.rays ? row.rays->max_error : row.figures.max_error;
            worst.wrong = std::max<std::size_t>(worst.wrong, failures);
            worst.wrong_at_edges = std::max(worst.wrong_at_edges, row.figures.wrong_at_edges);
            worst.max_error = std::max(worst.max_error, error);
            worst.nans = std::max(worst.nans, row.figures.nans);
            worst.infinities = std::max(worst.infinities, row.figures.infinities);
        }
    }
    return worst;
}

}  // namespace rt
