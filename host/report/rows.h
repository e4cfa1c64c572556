// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/measure/bench.h"

namespace rt {

/// A row of a benchmark with its position and its figures.
struct PlacedRow {
    const BenchRow* row = nullptr;
    std::optional<BenchFigures> figures;
    std::string source;  ///< "bench-0#/rows/3"
};

/// The rows of the page's scene of this index, in order.
std::vector<PlacedRow> rows_of(const BenchResult& result, std::size_t index);

/// The right rows in float of the largest picture with the most samples, for plots of devices.
std::vector<PlacedRow> largest_rows(const std::vector<PlacedRow>& rows);

/// Median seconds of tracing the same picture on the same device, if a row has it.
std::optional<double> trace_median(const BenchResult& result, const RenderStats& run);

std::int64_t pixels_of(const BenchCase& asked);

}  // namespace rt
