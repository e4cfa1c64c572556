// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "host/picture/render_stats.h"

namespace rt {

/// The middle value, or the mean of the two middle ones; 0 for none.
double median(std::vector<double> values);

/// The median distance from the median: noise, in the values' own unit; 0 for none.
double median_absolute_deviation(const std::vector<double>& values);

/// Distribution of repeated measurements.
struct Spread {
    double median = 0, mad = 0, min = 0, max = 0;

    /// MAD in percent of the median; 0 when the median is 0.
    double noise_percent() const { return median > 0 ? 100 * mad / median : 0; }
};

Spread spread_of(const std::vector<double>& values);

/// The spread of one figure over runs.
Spread spread_of(std::span<const RenderStats> runs,
                 const std::function<double(const RenderStats&)>& figure);

/// What the benchmarks call total, in seconds: flatten, open, build, upload, trace, resolve and
/// read back. Excludes process start, loading the scene and writing the picture.
double timed_total(const RenderStats& run);

/// The same without open and build, in seconds: what one more picture costs once the device is
/// open and the kernels are built.
double picture_seconds(const RenderStats& run);

double trace_seconds(const RenderStats& run);

}  // namespace rt
