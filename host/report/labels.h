// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host/measure/bench_result.h"
#include "host/measure/statistics.h"

namespace rt {

/// Who renders, in a few words: "2 threads", "2 threads, a buffer each", "PoCL".
std::string device_label(const BenchRow& row);

/// The device of a run in a few words: "threads", "PoCL".
std::string device_label(const RenderStats& run);

/// "plain" for one sample at the pixel's center, else the mode itself.
std::string aa_label(const AaMode& aa);

/// "12.3 ms ± 2 %": median and noise.
std::string spread_text(const Spread& spread);

/// Seconds as milliseconds without the unit, three digits, for columns whose head has the unit.
std::string milliseconds(double seconds);

}  // namespace rt
