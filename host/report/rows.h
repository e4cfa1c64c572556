// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/measure/bench.h"

namespace rt {

/// A row of a benchmark with its place in it and its figures.
struct PlacedRow {
    const BenchRow* row = nullptr;
    std::optional<BenchFigures> figures;
    std::string source;  ///< "bench-0#/rows/3"
};

/// The rows of the page's scene of this index, in order.
std::vector<PlacedRow> rows_of(const BenchResult& result, std::size_t index);

/// The right rows of the largest picture with most samples, in float: what plots of devices show.
std::vector<PlacedRow> largest_rows(const std::vector<PlacedRow>& rows);

/// The median seconds in which the same picture was traced on the same device, where rows tell.
std::optional<double> trace_median(const BenchResult& result, const RenderStats& run);

std::int64_t pixels_of(const BenchCase& asked);

}  // namespace rt
