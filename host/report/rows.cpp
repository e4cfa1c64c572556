// SPDX-License-Identifier: Apache-2.0
#include "host/report/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace rt {

std::vector<PlacedRow> rows_of(const BenchResult& result, std::size_t index) {
    std::vector<PlacedRow> rows;
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const BenchRow& row = result.rows[i];
        rows.push_back({&row, figures_of(result, row), fmt::format("bench-{}#/rows/{}", index, i)});
    }
    return rows;
}

std::optional<double> trace_median(const BenchResult& result, const RenderStats& run) {
    for (const BenchRow& row : result.rows) {
        const BenchCase& asked = row.asked;
        const bool same = asked.width == run.width && asked.height == run.height &&
                          asked.aa == run.aa && asked.double_precision == run.double_precision;
        const auto figures = same ? figures_of(result, row) : std::nullopt;
        if (!figures) continue;
        const DeviceStats& device = row.repeats.front().device;
        if (device.name == run.device.name && device.threads == run.device.threads &&
            device.schedule == run.device.schedule) {
            return figures->trace.median;
        }
    }
    return std::nullopt;
}

std::int64_t pixels_of(const BenchCase& asked) { return std::int64_t{asked.width} * asked.height; }

std::vector<PlacedRow> largest_rows(const std::vector<PlacedRow>& rows) {
    const auto work = [](const PlacedRow& placed) {
        return std::pair{pixels_of(placed.row->asked), placed.row->asked.aa.samples()};
    };
    std::pair<std::int64_t, int> most{0, 0};
    for (const PlacedRow& placed : rows) {
        if (placed.figures && !placed.row->asked.double_precision) {
            most = std::max(most, work(placed));
        }
    }
    std::vector<PlacedRow> largest;
    std::copy_if(
        rows.begin(), rows.end(), std::back_inserter(largest), [&](const PlacedRow& placed) {
            return placed.figures && !placed.row->asked.double_precision && work(placed) == most;
        });
    return largest;
}

}  // namespace rt
