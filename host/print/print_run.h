// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "host/measure/statistics.h"
#include "host/picture/render_stats.h"

namespace rt {

/// The first bytes of every result of this format.
std::string json_start(const std::string& format);

/// A run of a benchmark: settings, device, seconds, rays, rays per second, image and error, as in
/// stats_json.
nlohmann::ordered_json run_json(const RenderStats& run);

nlohmann::ordered_json runs_json(std::span<const RenderStats> runs);

/// {"median", "mad", "min", "max"}
nlohmann::ordered_json spread_json(const Spread& spread);

/// environment_json plus the load before the measurements and whether it makes the machine busy;
/// "load" itself is from after them.
nlohmann::ordered_json bench_environment_json(double load_before);

/// The first line of the CSV of bench and converge, without its newline.
std::string run_csv_header();

/// What a CSV line holds besides the run itself.
struct RunPlace {
    std::string device;   ///< spec
    std::string verdict;  ///< of the row or point
    int round = 0;        ///< 0: warm-up; repeats from 1
};

/// One run as a line with its newline; text with a comma or a quote in it is quoted (RFC 4180).
std::string run_csv_line(const RenderStats& run, const RunPlace& place);

}  // namespace rt
