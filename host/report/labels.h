// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/measure/bench_result.h"
#include "host/measure/statistics.h"

namespace rt {

/// Who renders, in a few words: "2 threads", "2 threads, sample buffers", "PoCL".
std::string device_label(const BenchRow& row);

/// The device of a run in a few words: "threads", "PoCL".
std::string device_label(const RenderStats& run);

/// "500 x 500", which no line break splits.
std::string size_text(int width, int height);

/// The samples of a pixel and, if it has several, the option: "2 x 2 samples per pixel (grid:2)".
std::string sampling_text(const AaMode& aa);

/// "12.3 ms ± 2 %": median and noise.
std::string spread_text(const Spread& spread);

/// Seconds as milliseconds without the unit, three digits, for columns whose head has the unit.
std::string milliseconds(double seconds);

}  // namespace rt
